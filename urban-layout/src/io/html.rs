//! A gallery of variations: one page with every plan and its figures.

use std::fmt::Write as _;

use crate::metrics::Metrics;

/// Columns of the table: heading, its title, figure.
type Column = (&'static str, &'static str, fn(&Metrics) -> String);

const COLUMNS: [Column; 12] = [
    ("Parcels", "number of parcels", |m| m.parcels.to_string()),
    ("p_n", "parcels per square kilometre", |m| {
        format!("{:.0}", m.p_n)
    }),
    ("p_angle", "mean corner deviation, degrees", |m| {
        format!("{:.2}", m.p_angle)
    }),
    ("p_area", "mean box over area", |m| {
        format!("{:.3}", m.p_area)
    }),
    ("Undesirable", "parcels over 15 degrees or 1.2", |m| {
        m.undesirable.to_string()
    }),
    ("l_r", "land in parcels, per cent", |m| {
        format!("{:.1}", m.l_r)
    }),
    ("l_s", "land in streets, per cent", |m| {
        format!("{:.1}", m.l_s)
    }),
    ("l_p", "land in parks, per cent", |m| {
        format!("{:.1}", m.l_p)
    }),
    ("l_o", "other land, per cent", |m| format!("{:.1}", m.l_o)),
    ("b_n", "blocks per square kilometre", |m| {
        format!("{:.0}", m.b_n)
    }),
    ("s_l", "streets, km per square kilometre", |m| {
        format!("{:.1}", m.s_l)
    }),
    ("s_d", "dead ends per square kilometre", |m| {
        format!("{:.1}", m.s_d)
    }),
];

const STYLE: &str = "\
:root{color-scheme:light}body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:1500px;padding:0 1.5rem;\
color:#3a3428;background:#fcfaf4}h1{font-weight:500;margin:0 0 .2rem}p{color:#857b68;margin:0 0 1.5rem}\
.plans{display:grid;grid-template-columns:repeat(auto-fill,minmax(430px,1fr));gap:1.25rem}\
figure{margin:0;background:#fff;border:1px solid #ddd6c6;border-radius:6px;overflow:hidden}\
figure img{width:100%;display:block}figcaption{padding:.6rem .9rem;border-top:1px solid #ddd6c6}\
figcaption b{margin-right:.6rem}table{border-collapse:collapse;margin:2rem 0;width:100%;font-variant-numeric:tabular-nums}\
th,td{padding:.35rem .6rem;text-align:right;border-bottom:1px solid #e6e0d2}th{font-weight:600}\
th:first-child,td:first-child{text-align:left}tbody tr:hover{background:#f4efe2}a{color:#8a4a2d}";

/// A page that shows plans side by side and compares their figures.
///
/// `cards` are the plans in order: the address of each one's SVG relative to the
/// page, and its figures. The page needs nothing but the pictures.
///
/// # Examples
///
/// ```
/// use urban_layout::io::html::index;
/// use urban_layout::metrics::Metrics;
///
/// let page = index("Kotka", &[("001/layout.svg".to_owned(), Metrics::default())]);
/// assert!(page.contains(r#"<img src="001/layout.svg""#));
/// ```
#[must_use]
pub fn index(name: &str, cards: &[(String, Metrics)]) -> String {
    let name = escaped(name);
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n\
         <title>{name}: variations</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>{name}</h1>\n\
         <p>{} variations; each is a street and parcel plan of the same site from another seed.</p>\n<div class=\"plans\">\n",
        cards.len()
    );
    for (number, (path, m)) in cards.iter().enumerate() {
        let (number, path) = (number + 1, escaped(path));
        let _ = writeln!(
            page,
            "<figure id=\"v{number}\"><a href=\"{path}\"><img src=\"{path}\" alt=\"Variation {number}\" loading=\"lazy\"></a>\
             <figcaption><b>{number}</b>seed {}: {} parcels, corners {:.1}\u{b0}, box / area {:.3}</figcaption></figure>",
            m.seed, m.parcels, m.p_angle, m.p_area
        );
    }
    page.push_str("</div>\n<table>\n<thead><tr><th>Variation</th><th>Seed</th>");
    for (heading, title, _) in COLUMNS {
        let _ = write!(page, "<th title=\"{title}\">{heading}</th>");
    }
    page.push_str("</tr></thead>\n<tbody>\n");
    for (number, (_, m)) in cards.iter().enumerate() {
        let number = number + 1;
        let _ = write!(
            page,
            "<tr><td><a href=\"#v{number}\">{number}</a></td><td>{}</td>",
            m.seed
        );
        for (.., figure) in COLUMNS {
            let _ = write!(page, "<td>{}</td>", figure(m));
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody>\n</table>\n</body>\n</html>\n");
    page
}

/// Text in HTML, also inside quotes.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_break_the_page() {
        let page = index("<script>", &[("a\"b.svg".to_owned(), Metrics::default())]);
        assert!(!page.contains("<script>") && !page.contains("a\"b"));
        assert_eq!(page.matches("<tr>").count(), 2);
    }
}
