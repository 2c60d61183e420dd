//! The page as one file with embedded styles, scripts and compressed WebAssembly.
//!
//! A file opened from disk may neither load a module nor start a worker from another file. The
//! worker is therefore made from text, and the browser unpacks the module.

use std::{error::Error, fs, path::Path};

/// Scripts of the worker.
const WORKER: [&str; 2] = ["overact.js", "worker.js"];

/// Writes `overact.html`; `overact_bg.wasm.gz` is the gzip-compressed module.
pub(crate) fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    let read = |name: &str| fs::read_to_string(folder.join(name));
    let mut html = read("index.html")?;
    let own = "script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self';";
    let inline = "script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:;";
    html = replaced(&html, own, inline)?;
    let link = "<link rel=\"stylesheet\" href=\"style.css\">";
    html = replaced(
        &html,
        link,
        &format!("<style>\n{}</style>", read("style.css")?),
    )?;
    let module = base64(&fs::read(folder.join("overact_bg.wasm.gz"))?);
    let worker = WORKER
        .map(read)
        .into_iter()
        .collect::<Result<Vec<_>, _>>()?;
    let worker = serde_json::to_string(&worker.join("\n"))?;
    let embedded = format!(
        "const EMBEDDED = async () => {{\n\
         \x20 const bytes = Uint8Array.from(atob('{module}'), one => one.charCodeAt(0));\n\
         \x20 const unpacked = new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip')));\n\
         \x20 const script = URL.createObjectURL(new Blob([{}], {{ type: 'text/javascript' }}));\n\
         \x20 return {{ module: await WebAssembly.compile(await unpacked.arrayBuffer()), script }};\n\
         }};\n",
        within_script(&worker)
    );
    let mut first = true;
    for name in [
        "robots.js",
        "calls.js",
        "editor.js",
        "drawing.js",
        "model.js",
        "identification.js",
        "page.js",
    ] {
        let tag = format!("<script src=\"{name}\"></script>");
        let before = if std::mem::take(&mut first) {
            embedded.as_str()
        } else {
            ""
        };
        let script = within_script(&read(name)?);
        html = replaced(&html, &tag, &format!("<script>\n{before}{script}</script>"))?;
    }
    Ok(fs::write(folder.join("overact.html"), html)?)
}

/// Replaces the only occurrence of `from`.
fn replaced(text: &str, from: &str, to: &str) -> Result<String, Box<dyn Error>> {
    match text.split_once(from) {
        Some((before, after)) => Ok(format!("{before}{to}{after}")),
        None => Err(format!("index.html has no `{from}`").into()),
    }
}

/// Escapes a script so that it does not end its element; in a script's string, `<\/` is `</`.
fn within_script(script: &str) -> String {
    script.replace("</", "<\\/").replace("<!--", "<\\!--")
}

/// Base64 encoding.
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for part in bytes.chunks(3) {
        let bits = part
            .iter()
            .fold(0_usize, |bits, byte| bits << 8 | usize::from(*byte))
            << (8 * (3 - part.len()));
        for place in 0..4 {
            text.push(if place <= part.len() {
                char::from(LETTERS[bits >> (18 - 6 * place) & 63])
            } else {
                '='
            });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{base64, within_script};

    #[test]
    fn base64_matches_known_values() {
        let known = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ];
        for (bytes, text) in known {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(base64(&[0xff, 0xfe]), "//4=");
    }

    #[test]
    fn script_content_cannot_end_the_script_element() {
        assert!(!within_script("const a = \"</script><!--\";").contains("</script"));
    }
}
