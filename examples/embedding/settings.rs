use framewright::{Change, Device, Error, Renderer, RendererOptions, Scene, SceneDrawSource, Texels};

/// Draws a scene twice, with more light in the second picture, and then at another size.
pub(crate) fn draw(device: &Device, scene: &Scene) -> Result<Vec<Texels>, Error> {
    let mut renderer = Renderer::open(device, "forward", RendererOptions::default())?;
    // What a user may choose stands in the document.
    for setting in &renderer.document().settings {
        println!("{}: {}", setting.name.text, setting.about.as_deref().unwrap_or_default());
    }
    // Conditions of the pipeline ask for facts of the scene: without glass no pass draws glass.
    renderer.set_scene(scene);
    renderer.preset(Some("reference"))?;

    let mut objects = None;
    let mut pictures = Vec::new();
    for (white_point, extent) in [(100, [64, 36]), (1, [64, 36]), (1, [32, 32])] {
        renderer.set("white_point", white_point)?;
        renderer.set_extent(extent)?;
        // Planned only if something changed. The draw source goes by the Plan's views, so it follows.
        let prepared = renderer.prepare()?;
        objects = match (prepared.change, objects) {
            (Change::Executor { .. }, _) | (_, None) => {
                Some(SceneDrawSource::for_plan(device, scene, extent, prepared.plan)?)
            }
            (_, objects) => objects,
        };
        if let Some(objects) = &mut objects {
            renderer.frame(objects)?;
        }
        pictures.push(renderer.read("screen")?);
    }
    // A mistake is an error of its call. The text has the place in the file; the data is there too.
    if let Err(mistake) = renderer.set("msaa", 3) {
        println!("{mistake}");
    }
    Ok(pictures)
}
