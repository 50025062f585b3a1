//! Tests of tables in the formats of other programs.

use proptest::prelude::{any, proptest};

use super::*;

const COLUMNS: [&[&str]; 2] = [&["col", "volts"], &["col", "volts", "newtons"]];

/// The numbers of a table, its problems, and the columns that are not read.
type Found = (Vec<Vec<f64>>, Vec<String>, Vec<String>);

fn read(bytes: &[u8]) -> Result<Found, TableError> {
    let mut table = TableReader::new(bytes, &COLUMNS)?;
    let (mut row, mut rows) = (TableRow::default(), Vec::new());
    let width = COLUMNS[table.header()].len();
    while table.next_row(&mut row)? {
        let numbers: Option<Vec<f64>> =
            (0..width).map(|field| table.number(&row, field, -1e3..=1e3)).collect();
        rows.extend(numbers);
    }
    let notes = table.into_notes();
    let problems = notes.problems.shown().iter().map(ToString::to_string).collect();
    Ok((rows, problems, notes.unread))
}

/// The rows of a table without problems.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let (rows, problems, _) = read(text.as_bytes()).unwrap();
    assert_eq!(problems, [""; 0], "{text:?}");
    rows
}

fn refusal(bytes: &[u8]) -> String {
    read(bytes).unwrap_err().to_string()
}

const TWO_ROWS: [[f64; 2]; 2] = [[1.0, 2.5], [3.0, 4.5]];

#[test]
fn blank_lines_may_stand_anywhere() {
    for text in [
        "col,volts\n1,2.5\n3,4.5\n\n",
        "\n\ncol,volts\n\n1,2.5\n \t \n3,4.5",
        "col,volts\n,\n1,2.5\n , \n\"\",\"\"\n3,4.5\n,,,\n",
        ",,\ncol,volts\r\n\r\n1,2.5\r\n3,4.5\r\n\r\n",
    ] {
        assert_eq!(rows(text), TWO_ROWS, "{text:?}");
    }
}

#[test]
fn every_end_of_line_ends_a_line() {
    for end in ["\n", "\r\n", "\r"] {
        let text = ["col,volts", "1,2.5", "", "3,4.5", "x,1", ""].join(end);
        let (rows, problems, _) = read(text.as_bytes()).unwrap();
        assert_eq!(rows, TWO_ROWS, "{end:?}");
        assert_eq!(problems.len(), 1);
        assert!(problems[0].starts_with("line 5, column col"), "{end:?}: {problems:?}");
    }
}

#[test]
fn headers_may_be_quoted_spaced_or_in_another_order() {
    for text in [
        "\"col\",\"volts\"\n1,2.5\n3,4.5",
        "col , volts\n 1 , 2.5 \n3,\t4.5",
        " \"col\", \"volts\"\n\"1\", \"2.5\"\n\"3\",\"4.5\"",
        "\u{feff}Col,VOLTS\n1,2.5\n3,4.5",
        "\u{feff}\"volts\",\"col\"\n2.5,1\n4.5,3",
        "volts,col,\n2.5,1,\n4.5,3,,,\n",
        "# made by hand\ncol,volts\n1,2.5\n# the second\n3,4.5",
        "# \"unclosed\ncol,volts\n1,2.5\n3,4.5",
        "sep=,\ncol,volts\n1,2.5\n3,4.5",
        // numpy.savetxt.
        "# col,volts\n1.0e+00,2.5e+00\n3.0e+00,4.5e+00\n",
    ] {
        assert_eq!(rows(text), TWO_ROWS, "{text:?}");
    }
}

#[test]
fn semicolons_let_commas_be_decimal_marks() {
    for text in [
        "col;volts\n1;2,5\n3;4,5",
        "sep=;\r\n\"col\";\"volts\"\r\n1;\"2,5\"\r\n3;4.5",
        "col\tvolts\n1\t2.5\n3\t4.5",
    ] {
        assert_eq!(rows(text), TWO_ROWS, "{text:?}");
    }
    let (rows, problems, _) = read(b"col;volts\n1;1.000,5\n1;1,0,5\n2;0,5").unwrap();
    assert_eq!(rows, [[2.0, 0.5]]);
    assert_eq!(problems.len(), 2, "{problems:?}");
}

#[test]
fn a_decimal_comma_among_commas_is_named() {
    let (rows, problems, _) = read(b"col,volts\n1,2,5\n1,\"2,5\"\n3,4.5").unwrap();
    assert_eq!(rows, [[3.0, 4.5]]);
    assert_eq!(
        problems,
        [
            "line 2: expected 2 fields, found 3; where a comma is the decimal mark, semicolons separate fields",
            "line 3, column volts: expected a number from -1000 to 1000, found \"2,5\"; write the decimal mark as a \
             point",
        ]
    );
    let (_, problems, _) = read(b"col\tvolts\n1\t2,5").unwrap();
    assert!(problems[0].ends_with("write the decimal mark as a point"), "{problems:?}");
}

#[test]
fn rows_separated_unlike_their_header_are_named() {
    let (rows, problems, _) = read(b"col,volts\n1;2.5\n3,4.5\n1\t2").unwrap();
    assert_eq!(rows, [[3.0, 4.5]]);
    assert_eq!(
        problems,
        [
            "line 2: expected 2 fields, found 1; semicolons separate them, unlike those of the header",
            "line 4: expected 2 fields, found 1; tabs separate them, unlike those of the header",
        ]
    );
}

#[test]
fn further_columns_are_named_and_not_read() {
    let (rows, problems, unread) =
        read(b"note,volts,by,col\n\"warm, dry\",2.5,ab,1\n\xb0C,4.5,,3\nshort,1\n").unwrap();
    assert_eq!(rows, TWO_ROWS);
    assert_eq!(problems, ["line 4: expected 4 fields, found 2"]);
    assert_eq!(unread, ["note", "by"]);
    // A row may lack a column that is not read.
    assert_eq!(read(b"col,volts,note\n1,2.5\n3,4.5,x").unwrap().0, TWO_ROWS);
}

#[test]
fn the_header_that_reads_most_is_chosen() {
    assert_eq!(rows("newtons,col,volts\n7,1,2.5\n8,3,4.5"), [[1.0, 2.5, 7.0], [3.0, 4.5, 8.0]]);
}

#[test]
fn headers_that_do_not_fit_are_refused_with_the_cause() {
    assert_eq!(
        refusal(b"col,vlts\n"),
        "line 1: the column volts is missing (is it \"vlts\"?); expected the header col,volts or col,volts,newtons"
    );
    assert!(refusal(b"col,volts,col\n").contains("the column col is there twice"));
    assert_eq!(
        refusal(b"\n1.5,2.5\n"),
        "line 2: expected the header col,volts or col,volts,newtons, found \"1.5,2.5\""
    );
    for empty in [&b""[..], b"\n\n", b"# nothing\n", b"\xef\xbb\xbf"] {
        assert!(refusal(empty).contains("the table is empty"), "{empty:?}");
    }
    let utf16: Vec<u8> = "\u{feff}col,volts\n1,2\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(refusal(&utf16).contains("UTF-16"));
    assert!(refusal("col,volts".repeat(20_000).as_bytes()).contains("longer than 64 kB"));
    assert!(refusal(b"col,\"volts\n1,2").contains("a quotation mark is not closed"));
}

#[test]
fn a_line_without_an_end_takes_no_memory() {
    struct Endless(u64);
    impl io::Read for Endless {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let count = buffer.len().min(usize::try_from(self.0).unwrap());
            buffer[..count].fill(b'1');
            self.0 -= count as u64;
            Ok(count)
        }
    }
    let text = io::Read::chain(&b"col,volts\n1,2.5\n"[..], Endless(300 << 20));
    let reader = io::BufReader::new(io::Read::chain(text, &b"\n3,4.5\n"[..]));
    let mut table = TableReader::new(reader, &COLUMNS).unwrap();
    let mut row = TableRow::default();
    let mut lines = Vec::new();
    while table.next_row(&mut row).unwrap() {
        lines.push(row.line());
    }
    assert_eq!(lines, [2, 4]);
    assert_eq!(table.problems().to_string(), "line 3: longer than 64 kB");
    assert!(table.lines.capacity() <= 256 << 10);
}

#[test]
fn whole_numbers_may_be_written_as_floats_and_only_whole() {
    let mut table =
        TableReader::new(&b"col,volts\n3.0,0\n3e0,0\n+3,0\n3.5,0\n-1,0\n9,0"[..], &COLUMNS).unwrap();
    let (mut row, mut found) = (TableRow::default(), Vec::new());
    while table.next_row(&mut row).unwrap() {
        found.push(table.whole(&row, 0, 0..9));
    }
    assert_eq!(found, [Some(3), Some(3), Some(3), None, None, None]);
    assert_eq!(table.problems().lines(), 3);
}

proptest! {
    #[test]
    fn no_bytes_make_it_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        let _ = read(&bytes);
        let _ = read(&[b"col,volts\n", &bytes[..]].concat());
    }
}
