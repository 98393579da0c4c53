//! Scenes.

room! {
    "Scenes";

    /// The scene has more than is allowed.
    ///
    /// Objects, lights and textures of a scene are bounded. The help names the bound.
    SCENE_TOO_LARGE = 1401,

    /// The camera of a scene can't see.
    ///
    /// A camera has a direction: its target isn't where it stands, and up isn't along it. The far distance is greater than the
    /// near one. A scene without objects says where its camera is.
    SCENE_CAMERA = 1402,

    /// A direction, colour or material of a scene is none.
    ///
    /// Directions have a length, colours are `"#rrggbb"` or three numbers from 0 to 1, and each object has a material.
    SCENE_VALUE = 1403,

    /// The glTF file can't be used.
    ///
    /// It is damaged, or needs something that isn't read. The message names the part of it. Small mistakes are passed over unless
    /// `--strict` is given.
    SCENE_GLTF = 1404,

    /// The file is no scene.
    ///
    /// A scene is a file that ends in `.glb`, `.gltf` or `.ron`.
    SCENE_KIND = 1405,
}
