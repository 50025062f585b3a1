//! Lists of a layout and how long each may be.

use super::fields::Fields;
use super::node::Node;

/// Most controls, regions or stance zones of one layout.
pub const MAX_WIDGETS: usize = 4096;

/// What `read` makes of the entries of the list `name`, which may be left out, and whether that is all of them.
pub(super) fn list<'r, T>(
    fields: &mut Fields<'r>,
    name: &'static str,
    entry: &'static str,
    read: impl FnMut(Node<'r>) -> Option<T>,
) -> (Vec<T>, bool) {
    let Some(node) = fields.take(name) else { return (Vec::new(), !fields.are_broken()) };
    let Some(nodes) = node.list(entry, MAX_WIDGETS) else { return (Vec::new(), false) };
    let count = nodes.len();
    let read: Vec<T> = nodes.into_iter().filter_map(read).collect();
    let all = read.len() == count && !node.reader.is_broken(&node.span());
    (read, all)
}
