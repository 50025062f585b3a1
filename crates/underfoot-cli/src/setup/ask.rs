//! Questions at the terminal.

use std::io::{BufRead, Write, stdin, stdout};

/// The person has left: Ctrl-D, or the end of the input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Left;

/// Asks a question until `read` understands the answer; an empty line is `usual`, if there is one.
pub(super) fn ask<T>(
    question: &str,
    usual: Option<&str>,
    read: impl Fn(&str) -> Result<T, String>,
) -> Result<T, Left> {
    loop {
        match usual {
            Some(usual) => out!("{question} [{usual}]: "),
            None => out!("{question}: "),
        }
        let answer = line()?;
        let answer = if answer.is_empty() { usual.unwrap_or_default() } else { answer.as_str() };
        match read(answer) {
            Ok(read) => return Ok(read),
            Err(why) => outln!("  {why}"),
        }
    }
}

/// Reads a line without the blanks around it.
fn line() -> Result<String, Left> {
    // The question waits in the buffer of the output otherwise; a closed output is noted elsewhere.
    let _ = stdout().flush();
    let mut line = String::new();
    match stdin().lock().read_line(&mut line) {
        Ok(1..) => Ok(line.trim().to_owned()),
        Ok(0) | Err(_) => {
            outln!();
            Err(Left)
        }
    }
}

/// Reads a number within a range; `unit` follows the range in the message.
pub(super) fn number(
    range: std::ops::RangeInclusive<f64>,
    unit: &'static str,
) -> impl Fn(&str) -> Result<f64, String> {
    move |text| crate::number::number(&text.replace(',', "."), &range, unit)
}

/// Reads the number of one of `choices`, from 1; returns its position.
pub(super) fn choice(choices: usize) -> impl Fn(&str) -> Result<usize, String> {
    move |text| {
        let number = text.parse::<usize>().ok().filter(|number| (1..=choices).contains(number));
        number.map(|number| number - 1).ok_or_else(|| format!("expected a number from 1 to {choices}"))
    }
}
