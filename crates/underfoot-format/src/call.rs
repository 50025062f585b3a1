//! Values written as a name with positional values behind it, such as `Key("viewer", "Right")`.

use ron2::ast::{Expr, StructBody};

use super::node::Node;
use super::problem::Problem;
use super::suggest::{listed, nearest};

/// A name and the values in the brackets behind it.
pub struct Call<'r> {
    /// The name, one of those that were asked for.
    pub name: &'static str,
    /// The values, in their order.
    pub values: Vec<Node<'r>>,
    node: Node<'r>,
}

impl<'r> Node<'r> {
    /// Returns the one of `names` that is written, and the values in the brackets behind it; a name alone has none.
    pub fn call(&self, names: &[&'static str]) -> Option<Call<'r>> {
        let expected = listed(names, "or");
        let Expr::Struct(written) = self.expr else { return self.mismatch(&expected) };
        let called = &*written.name.name;
        let Some(name) = names.iter().copied().find(|name| *name == called) else {
            let message = format!("there is no `{}` called {called}", self.name);
            let help = nearest(called, names.iter().copied()).map(|name| format!("did you mean {name}?"));
            let problem = Problem::error(self.span(), message).expected(format!("expected {expected}"));
            self.report(problem.help_if(help));
            return None;
        };
        let values = match &written.body {
            None => Vec::new(),
            Some(StructBody::Tuple(body)) => {
                let values = body.elements.iter().map(|value| Node { expr: &value.expr, name, ..*self });
                values.map(Node::inside).collect()
            }
            Some(_) => return self.mismatch("values without names, separated by commas"),
        };
        Some(Call { name, values, node: *self })
    }
}

impl<'r> Call<'r> {
    /// Returns the `required` values and the optional one behind them; reports another number of values together with
    /// the `form` that is valid.
    pub fn values<const N: usize>(&self, form: &str) -> Option<([Node<'r>; N], Option<Node<'r>>)> {
        let (required, rest) = self.values.split_at_checked(N).unwrap_or((&[], &self.values));
        match (<[Node<'r>; N]>::try_from(required.to_vec()), rest) {
            (Ok(required), []) => Some((required, None)),
            (Ok(required), [last]) => Some((required, Some(*last))),
            _ => {
                let message = format!("{} has another number of values", self.name);
                let problem = Problem::error(self.node.span(), message);
                self.node.report(problem.expected(format!("expected {form}")));
                None
            }
        }
    }

    /// Reports that there is a value too many at `extra`, and returns `None`; without one, returns `value`.
    pub fn without<T>(&self, extra: Option<Node<'r>>, form: &str, value: T) -> Option<T> {
        let Some(extra) = extra else { return Some(value) };
        let problem = Problem::error(extra.span(), format!("{} takes no more values", self.name));
        extra.report(problem.expected(format!("expected {form}")));
        None
    }
}
