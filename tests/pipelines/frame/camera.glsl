// The camera for what draws with buffers of its own, as `camera_copy.comp` writes it.
struct CameraData { mat4 world_to_clip; mat4 clip_to_world; mat4 before; vec4 place; };
struct Instance { vec4 sphere; vec4 color; };
