//! Plans as PNG pictures.

use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use crate::error::{Error, Result};

/// Largest width of a picture, pixels.
const MAX_WIDTH: u32 = 20_000;

/// Renders an SVG document as PNG bytes, `width` pixels wide.
///
/// Lettering made by [`svg`](fn@super::svg::svg) is drawn as lines and so appears
/// on any machine; text elements of other documents (and labels in scripts that
/// the lettering lacks) appear only where a font is loaded, which this is not.
///
/// # Errors
///
/// A usage error if the text is no SVG, or the picture would be empty or wider
/// than 20 000 pixels.
///
/// # Examples
///
/// ```
/// use urban_layout::io::png::png;
///
/// let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 30"><rect width="9" height="9"/></svg>"#;
/// let bytes = png(svg, 80)?;
/// assert_eq!(&bytes[1..4], b"PNG");
/// # Ok::<(), urban_layout::Error>(())
/// ```
pub fn png(svg: &str, width: u32) -> Result<Vec<u8>> {
    let tree = Tree::from_str(svg, &Options::default())
        .map_err(|e| Error::usage(format!("the picture cannot be drawn: {e}")))?;
    let size = tree.size();
    let height = (f64::from(width) * f64::from(size.height()) / f64::from(size.width())).round();
    if width == 0 || width > MAX_WIDTH || !(1.0..=f64::from(MAX_WIDTH)).contains(&height) {
        return Err(Error::usage(format!(
            "a picture of {width} x {height} pixels cannot be drawn; choose a width from 1 to {MAX_WIDTH}"
        )));
    }
    let mut pixels = Pixmap::new(width, height as u32)
        .ok_or_else(|| Error::usage("the picture is too large"))?;
    pixels.fill(Color::WHITE);
    let scale = width as f32 / size.width();
    resvg::render(
        &tree,
        Transform::from_scale(scale, scale),
        &mut pixels.as_mut(),
    );
    pixels
        .encode_png()
        .map_err(|e| Error::usage(format!("the picture cannot be encoded: {e}")))
}
