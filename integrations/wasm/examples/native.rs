//! The same drawing by this machine's own code, to compare: `native PHOTO STYLE WIDTH OUT.svg`

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let [photo, style, width, out] = &std::env::args().skip(1).collect::<Vec<_>>()[..] else {
        return Err("give a photograph, a style, a width in mm and the name of an SVG".into());
    };
    let svg = drypoint_wasm::drawn(&std::fs::read(photo)?, style, "", width.parse()?, 0)?;
    Ok(std::fs::write(out, svg)?)
}
