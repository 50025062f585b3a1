//! `/dashboard`: a page that shows `/health`, in three files of its own so that its policy admits no inline script.

/// The page loads its own files and `/health`, nothing else, and no other page may frame it.
pub(super) const POLICY: &str = "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; \
    connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n\
    Referrer-Policy: no-referrer\r\n";

/// The type and the text of the dashboard's file at this path.
pub(super) fn file(path: &str) -> Option<(&'static str, &'static str)> {
    match path {
        "/dashboard" => Some(("text/html; charset=utf-8", include_str!("dashboard.html"))),
        "/dashboard.css" => Some(("text/css; charset=utf-8", include_str!("dashboard.css"))),
        "/dashboard.js" => Some(("text/javascript; charset=utf-8", include_str!("dashboard.js"))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_nothing_that_its_policy_refuses() {
        let page = file("/dashboard").map_or("", |(_, text)| text);
        let script = file("/dashboard.js").map_or("", |(_, text)| text);
        assert!(page.contains(r#"src="/dashboard.js""#) && page.contains(r#"href="/dashboard.css""#));
        for inline in ["<style", " style=", "onclick", "onload", "http:", "https:", "<script>"] {
            assert!(!page.contains(inline), "{inline}");
        }
        // Texts come from files and boards: none becomes markup.
        for dangerous in ["innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", ".style"]
        {
            assert!(!script.contains(dangerous), "{dangerous}");
        }
    }
}
