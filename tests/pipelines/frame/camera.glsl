// Where the camera was in the frame before, as `camera_copy.comp` keeps it, and what the GPU culls and draws by itself.
struct CameraData { mat4 world_to_clip; };
struct Instance { vec4 sphere; vec4 color; };
