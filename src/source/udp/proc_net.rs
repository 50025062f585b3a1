//! Linux's data on UDP sockets in `/proc`; none on other systems.

use std::net::{SocketAddr, UdpSocket};

/// Number of datagrams that the kernel dropped on `socket` because its buffer was full; `None` if it does not report
/// it.
#[cfg(target_os = "linux")]
pub(super) fn drops(socket: &UdpSocket) -> Option<u64> {
    use std::os::fd::AsRawFd;
    let link = std::fs::read_link(format!("/proc/self/fd/{}", socket.as_raw_fd())).ok()?;
    let inode: u64 = link.to_str()?.strip_prefix("socket:[")?.strip_suffix(']')?.parse().ok()?;
    let file = if socket.local_addr().ok()?.is_ipv4() { "/proc/net/udp" } else { "/proc/net/udp6" };
    let table = std::fs::read_to_string(file).ok()?;
    rows(&table).find(|row| row.inode == inode).map(|row| row.drops)
}

/// Other systems do not report drops.
#[cfg(not(target_os = "linux"))]
pub(super) fn drops(_: &UdpSocket) -> Option<u64> {
    None
}

/// Process that listens on the port of `address`, if this program may see it: `name (process 123)`.
#[cfg(target_os = "linux")]
pub(super) fn owner(address: SocketAddr) -> Option<String> {
    let inode = ["/proc/net/udp", "/proc/net/udp6"].into_iter().find_map(|file| {
        let table = std::fs::read_to_string(file).ok()?;
        rows(&table).find(|row| row.port == address.port()).map(|row| row.inode)
    })?;
    let wanted = format!("socket:[{inode}]");
    std::fs::read_dir("/proc").ok()?.flatten().find_map(|process| {
        let id: u32 = process.file_name().to_str()?.parse().ok()?;
        let mut files = std::fs::read_dir(process.path().join("fd")).ok()?.flatten();
        files.find(|file| std::fs::read_link(file.path()).is_ok_and(|link| link.as_os_str() == &*wanted))?;
        let name = std::fs::read_to_string(process.path().join("comm")).ok()?;
        Some(format!("{} (process {id})", name.trim()))
    })
}

/// Other systems do not report it.
#[cfg(not(target_os = "linux"))]
pub(super) fn owner(_: SocketAddr) -> Option<String> {
    None
}

/// One line of `/proc/net/udp`.
#[cfg(any(target_os = "linux", test))]
#[derive(Debug, PartialEq, Eq)]
struct Row {
    port: u16,
    inode: u64,
    drops: u64,
}

#[cfg(any(target_os = "linux", test))]
fn rows(table: &str) -> impl Iterator<Item = Row> + '_ {
    table.lines().skip(1).filter_map(|line| {
        let columns: Vec<&str> = line.split_whitespace().collect();
        let (_, port) = columns.get(1)?.rsplit_once(':')?;
        Some(Row {
            port: u16::from_str_radix(port, 16).ok()?,
            inode: columns.get(9)?.parse().ok()?,
            drops: columns.get(12)?.parse().ok()?,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernels_table_is_read() {
        let table = "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode ref pointer drops
  101: 0100007F:2328 00000000:0000 07 00000000:00000000 00:00000000 00000000  1000        0 31337 2 0000000000000000 42
  102: cut short
";
        assert_eq!(rows(table).collect::<Vec<_>>(), [Row { port: 9000, inode: 31337, drops: 42 }]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_socket_of_our_own_is_found() {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        assert_eq!(drops(&socket), Some(0));
        let owner = owner(socket.local_addr().unwrap()).unwrap();
        assert!(owner.contains(&std::process::id().to_string()), "{owner}");
    }
}
