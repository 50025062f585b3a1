use ron2::ast::Expr;

use super::super::fields::Fields;
use super::super::node::Node;
use super::super::problem::Problem;
use super::super::suggest::{listed, nearest};

/// Which of `names` is written, and the settings in the brackets behind it, if there are any.
pub(in crate::schema) fn read<'r>(
    node: Node<'r>,
    names: &[&'static str],
) -> Option<(&'static str, Option<Fields<'r>>)> {
    let expected = listed(names, "or");
    let Expr::Struct(variant) = node.expr else { return node.mismatch(&expected) };
    let written = &*variant.name.name;
    let Some(name) = names.iter().copied().find(|name| *name == written) else {
        let problem = Problem::error(node.span(), format!("there is no `{}` called {written}", node.what));
        let help = nearest(written, names.iter().copied()).map(|name| format!("did you mean {name}?"));
        node.report(problem.expected(format!("expected {expected}")).help_if(help));
        return None;
    };
    match &variant.body {
        None => Some((name, None)),
        Some(_) => Some((name, Some(node.fields(name)?))),
    }
}
