/* Objects of a program in C: vertex buffers, indices, bind groups and push constants, for each kind of draws. What is read back is compared with
 * what the program gave. */

#include "testing.h"

enum { SIZE = 8 };

static const char PIPELINE[] =
    "Pipeline(version: 1,\n"
    "    images: [(name: \"screen\", format: R8G8B8A8_UNORM, size: Output), (name: \"seen\", format: R8G8B8A8_UNORM, size: Output),\n"
    "        (name: \"own\", format: R8G8B8A8_UNORM, size: Output), (name: \"computed\", format: R8G8B8A8_UNORM, size: Output)],\n"
    "    passes: [(name: \"objects\", draw: Objects(Opaque), shader: \"object\", color: [(image: \"screen\", clear: (0.0, 0.0, 0.0, 0.0))]),\n"
    "        (name: \"mark\", custom: \"mark\", params: {\"corner\": (7.0, 0.0), \"marks\": true}, color: [\"screen\"]),\n"
    "        (name: \"seen\", draw: FullScreen(\"seen\"), color: [\"seen\"]),\n"
    "        (name: \"own\", draw: Vertices(3), shader: \"own\", color: [(image: \"own\", clear: (0.0, 0.0, 0.0, 0.0))]),\n"
    "        (name: \"compute\", dispatch: \"computed\", groups: Texels(\"computed\"),\n"
    "            storage: {\"target\": (image: \"computed\", access: Write)})],\n"
    "    outputs: [\"screen\", \"seen\", \"own\", \"computed\"])\n";

static const char OBJECT_VERT[] =
    "#version 460\n"
    "layout(location = 3) in vec2 place;\n"
    "layout(location = 0) in vec4 rectangle;\n"
    "layout(location = 1) in vec4 tint;\n"
    "layout(set = 1, binding = 0) uniform Camera { vec4 seen; } camera;\n"
    "layout(location = 0) out vec4 tint_of_vertex;\n"
    "layout(location = 1) flat out uint number;\n"
    "void main() {\n"
    "    gl_Position = vec4((rectangle.xy + rectangle.zw * place) * camera.seen.xy, 0.0, 1.0);\n"
    "    tint_of_vertex = tint;\n"
    "    number = gl_InstanceIndex;\n"
    "}\n";
/* Each channel comes from elsewhere. */
static const char OBJECT_FRAG[] =
    "#version 460\n"
    "layout(location = 0) in vec4 tint_of_vertex;\n"
    "layout(location = 1) flat in uint number;\n"
    "layout(set = 2, binding = 4) readonly buffer Materials { vec4 colors[]; } materials;\n"
    "layout(set = 2, binding = 7) uniform sampler2D textures[2];\n"
    "layout(push_constant) uniform Object { vec4 color; } object;\n"
    "layout(location = 0) out vec4 color;\n"
    "void main() {\n"
    "    color = vec4(tint_of_vertex.r, texture(textures[1], vec2(0.5)).g, object.color.b, materials.colors[number].a);\n"
    "}\n";
/* All of the viewport, of a strip. */
static const char MARK_VERT[] =
    "#version 460\n"
    "void main() { gl_Position = vec4(2.0 * vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) - 1.0, 0.0, 1.0); }\n";
static const char MARK_FRAG[] =
    "#version 460\n"
    "layout(set = 0, binding = 0) uniform Params { vec2 corner; bool marks; } params;\n"
    "layout(push_constant) uniform Mark { vec4 color; } mark;\n"
    "layout(location = 0) out vec4 color;\n"
    "void main() { color = params.marks ? mark.color : vec4(params.corner, 0.0, 0.0); }\n";
static const char SEEN[] =
    "#version 460\n"
    "layout(set = 1, binding = 0) uniform Camera { vec4 seen; } camera;\n"
    "layout(location = 0) out vec4 color;\n"
    "void main() { color = camera.seen.zzww; }\n";
static const char OWN_VERT[] =
    "#version 460\n"
    "void main() { gl_Position = vec4(4.0 * vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) - 1.0, 0.0, 1.0); }\n";
static const char COMPUTED[] =
    "#version 460\n"
    "layout(local_size_x = 8, local_size_y = 8) in;\n"
    "layout(set = 1, binding = 0) uniform Camera { vec4 seen; } camera;\n"
    "layout(set = 0, binding = 0, rgba8) uniform writeonly image2D target;\n"
    "void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), camera.seen.wwzz); }\n";

/* What draws bring along. */
static const FramewrightVertexBuffer BUFFERS[] = {{.stride = 4}, {.stride = 20, .instances = 1}};
static const FramewrightAttribute ATTRIBUTES[] = {
    {.name = "place", .format = VK_FORMAT_R16G16_SNORM},
    {.name = "rectangle", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .buffer = 1},
    {.name = "tint", .format = VK_FORMAT_R8G8B8A8_UNORM, .buffer = 1, .offset = 16}};
static const VkPushConstantRange PUSHED = {VK_SHADER_STAGE_FRAGMENT_BIT, 0, 16};
static const FramewrightSuppliedResource SUPPLIED[] = {
    {.name = "camera", .set = 1, .binding = 0, .kind = FRAMEWRIGHT_RESOURCE_KIND_UNIFORM_BLOCK},
    {.name = "materials", .set = 2, .binding = 4, .kind = FRAMEWRIGHT_RESOURCE_KIND_STORAGE_BLOCK},
    {.name = "textures", .set = 2, .binding = 7, .kind = FRAMEWRIGHT_RESOURCE_KIND_SAMPLED_IMAGE, .count = 2}};
static const FramewrightDrawInterface DRAWS[] = {
    {.draw = FRAMEWRIGHT_DRAW_OPAQUE, .vertex_buffers = BUFFERS, .vertex_buffer_count = 2, .attributes = ATTRIBUTES,
     .attribute_count = 3, .push_constants = &PUSHED, .push_constant_count = 1, .supplied = SUPPLIED, .supplied_count = 3},
    {.draw = FRAMEWRIGHT_DRAW_CUSTOM, .custom = "mark", .has_topology = 1, .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP,
     .push_constants = &PUSHED, .push_constant_count = 1},
    {.draw = FRAMEWRIGHT_DRAW_FULL_SCREEN, .supplied = SUPPLIED, .supplied_count = 1},
    {.draw = FRAMEWRIGHT_DRAW_VERTICES, .supplied = SUPPLIED, .supplied_count = 1},
    {.draw = FRAMEWRIGHT_DRAW_COMPUTE, .supplied = SUPPLIED, .supplied_count = 1}};

/* A square, whose indices begin behind two others: both triangles go round counter-clockwise. */
static const int16_t PLACES[][2] = {{0, 0}, {32767, 0}, {0, 32767}, {32767, 32767}};
static const uint16_t INDICES[] = {9, 9, 0, 2, 1, 1, 2, 3};
/* An instance that nobody draws, the left half, and the right half, which the camera shows half as wide. */
typedef struct {
    float rectangle[4];
    uint8_t tint[4];
} Instance;
static const Instance INSTANCES[] = {{{0}, {0}}, {{-2, -1, 2, 2}, {51, 1, 2, 3}}, {{0, -1, 2, 2}, {68, 4, 5, 6}}};
static const float CAMERA[] = {0.5f, 1.0f, 34.0f / 255.0f, 187.0f / 255.0f};
static const float MATERIALS[][4] = {{0, 0, 0, 204.0f / 255.0f}, {0, 0, 0, 221.0f / 255.0f}};
static const float COLORS[][4] = {
    {0, 0, 153.0f / 255.0f, 0}, {1, 1, 1, 1}, {0, 0, 7.0f / 255.0f, 0}, {11.0f / 255.0f, 22.0f / 255.0f, 33.0f / 255.0f, 44.0f / 255.0f}};

/* What the callback is given. */
typedef struct {
    OwnBuffer places, instances, indices, camera, materials;
    FramewrightBindGroup *camera_group, *material_group;
    int calls;
} Program;

static void draw_objects(const Program *program, const FramewrightPass *pass) {
    check(framewright_pass_bind_group(pass, 1, program->camera_group));
    check(framewright_pass_bind_group(pass, 2, program->material_group));
    check(framewright_pass_bind_vertex_buffer(pass, 0, program->places.buffer, 0, sizeof PLACES));
    check(framewright_pass_bind_vertex_buffer(pass, 1, program->instances.buffer, sizeof *INSTANCES, 2 * sizeof *INSTANCES));
    check(framewright_pass_bind_index_buffer(pass, program->indices.buffer, 4, sizeof INDICES - 4, VK_INDEX_TYPE_UINT16));
    check(framewright_pass_set_cull_mode(pass, VK_CULL_MODE_BACK_BIT));
    check(framewright_pass_push_constants(pass, 0, COLORS[0], 16));
    check(framewright_pass_draw_indexed(pass, 0, 6, 0, 0, 2));
    /* Nothing of it is seen. */
    check(framewright_pass_set_front_face(pass, VK_FRONT_FACE_CLOCKWISE));
    check(framewright_pass_push_constants(pass, 0, COLORS[1], 16));
    check(framewright_pass_draw_indexed(pass, 0, 6, 0, 0, 2));
    /* One texel of it is. */
    check(framewright_pass_set_cull_mode(pass, VK_CULL_MODE_NONE));
    check(framewright_pass_set_scissor(pass, 0, 0, 1, 1));
    check(framewright_pass_push_constants(pass, 0, COLORS[2], 16));
    check(framewright_pass_draw_indexed(pass, 0, 6, 0, 0, 2));
}

static void draw_mark(const FramewrightPass *pass) {
    double corner[2], marks;
    size_t count = 2;
    check(framewright_pass_param(pass, "corner", corner, &count));
    HOLDS(count == 2);
    count = 1;
    FAILS(framewright_pass_param(pass, "corner", corner, &count), MISUSE, "`corner` has 2 numbers, and there is room for 1");
    HOLDS(count == 2);
    FAILS(framewright_pass_param(pass, "corners", corner, &count), MISUSE, "the pass has no parameter `corners`");
    count = 1;
    check(framewright_pass_param(pass, "marks", &marks, &count));
    HOLDS(marks == 1);
    check(framewright_pass_set_viewport(pass, corner[0], corner[1], 1, 1));
    check(framewright_pass_push_constants(pass, 0, COLORS[3], 16));
    check(framewright_pass_draw(pass, 0, 4, 0, 1));
}

static void tells_nothing(const FramewrightPass *pass) {
    double number;
    size_t count = 1;
    HOLDS(pass->queue_family == VK_QUEUE_FAMILY_IGNORED);
    FAILS(framewright_pass_param(pass, "corner", &number, &count), MISUSE, "parameters of a compute pass are its shader's");
}

static uint32_t record(void *context, const FramewrightPass *pass) {
    Program *program = context;
    ++program->calls;
    HOLDS(pass->rotation == FRAMEWRIGHT_ROTATION_IDENTITY);
    switch (pass->draw) {
    case FRAMEWRIGHT_DRAW_OPAQUE:
        draw_objects(program, pass);
        return 1;
    case FRAMEWRIGHT_DRAW_CUSTOM:
        draw_mark(pass);
        return 1;
    case FRAMEWRIGHT_DRAW_FULL_SCREEN:
        check(framewright_pass_bind_group(pass, 1, program->camera_group));
        check(framewright_pass_draw(pass, 0, 3, 0, 1));
        return 1;
    case FRAMEWRIGHT_DRAW_VERTICES:
        HOLDS(pass->in_scope);
        check(framewright_pass_bind_group(pass, 1, program->camera_group));
        return 1;
    case FRAMEWRIGHT_DRAW_COMPUTE:
        HOLDS(!pass->in_scope && pass->commands == NULL && strcmp(pass->custom, "computed") == 0);
        FAILS(framewright_pass_draw(pass, 0, 3, 0, 1), MISUSE, "the pass is a compute pass");
        tells_nothing(pass);
        check(framewright_pass_bind_group(pass, 1, program->camera_group));
        return 1;
    default:
        return 0;
    }
}

/* Compares an output with what the program gave. */
static void compare(FramewrightRenderer *renderer, const char *name, const uint8_t expected[SIZE][SIZE][4]) {
    FramewrightTexels texels;
    check(framewright_renderer_read(renderer, name, &texels));
    HOLDS(texels.width == SIZE && texels.height == SIZE && texels.byte_count == SIZE * SIZE * 4);
    for (size_t at = 0; at < texels.byte_count; ++at) {
        int wanted = expected[at / 4 / SIZE][at / 4 % SIZE][at % 4];
        if (texels.bytes[at] != wanted) {
            fprintf(stderr, "`%s`: byte %zu is %d and not %d\n", name, at, texels.bytes[at], wanted);
            exit(EXIT_FAILURE);
        }
    }
}

static void compare_all(FramewrightRenderer *renderer) {
    uint8_t screen[SIZE][SIZE][4], seen[SIZE][SIZE][4], own[SIZE][SIZE][4], computed[SIZE][SIZE][4];
    for (int y = 0; y < SIZE; ++y) {
        for (int x = 0; x < SIZE; ++x) {
            const int right = x >= SIZE / 2;
            const uint8_t object[4] = {right ? 68 : 51, 102, x == 0 && y == 0 ? 7 : 153, right ? 221 : 204};
            const uint8_t mark[4] = {11, 22, 33, 44}, all[4] = {34, 34, 187, 187}, turned[4] = {187, 187, 34, 34};
            memcpy(screen[y][x], x == 7 && y == 0 ? mark : object, 4);
            memcpy(seen[y][x], all, 4);
            memcpy(own[y][x], all, 4);
            memcpy(computed[y][x], turned, 4);
        }
    }
    compare(renderer, "screen", (const uint8_t(*)[SIZE][4])screen);
    compare(renderer, "seen", (const uint8_t(*)[SIZE][4])seen);
    compare(renderer, "own", (const uint8_t(*)[SIZE][4])own);
    compare(renderer, "computed", (const uint8_t(*)[SIZE][4])computed);
}

int main(void) {
    write_file("object.vert", OBJECT_VERT);
    write_file("object.frag", OBJECT_FRAG);
    write_file("mark.vert", MARK_VERT);
    write_file("mark.frag", MARK_FRAG);
    write_file("seen.frag", SEEN);
    write_file("own.vert", OWN_VERT);
    write_file("own.frag", SEEN);
    write_file("computed.comp", COMPUTED);
    OwnDevice own;
    open_vulkan(&own);
    open_device(&own, NULL);
    Program program = {
        .places = filled_buffer(&own, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, PLACES, sizeof PLACES),
        .instances = filled_buffer(&own, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, INSTANCES, sizeof INSTANCES),
        .indices = filled_buffer(&own, VK_BUFFER_USAGE_INDEX_BUFFER_BIT, INDICES, sizeof INDICES),
        .camera = filled_buffer(&own, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, CAMERA, sizeof CAMERA),
        .materials = filled_buffer(&own, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MATERIALS, sizeof MATERIALS)};

    /* Of the second texture the green is seen. */
    const OwnImage images[] = {
        own_texel(&own, (VkClearColorValue){.float32 = {1, 1, 1, 1}}),
        own_texel(&own, (VkClearColorValue){.float32 = {1, 102.0f / 255.0f, 1, 1}})};
    const VkDescriptorImageInfo views[] = {own_view(&own, images[0]), own_view(&own, images[1])};
    const VkDescriptorBufferInfo camera = {program.camera.buffer, 0, sizeof CAMERA};
    const VkDescriptorBufferInfo materials = {program.materials.buffer, 0, sizeof MATERIALS};
    const FramewrightBinding of_camera = {.binding = 0, .buffer = &camera};
    const FramewrightBinding of_materials[] = {
        {.binding = 7, .images = views, .image_count = 2}, {.binding = 4, .buffer = &materials}};
    check(framewright_bind_group_open(own.device, DRAWS, 1, &of_camera, 1, &program.camera_group));
    check(framewright_bind_group_open(own.device, DRAWS, 2, of_materials, 2, &program.material_group));

    const char *shaders = ".", *custom = "mark";
    FramewrightRendererOptions options = {
        .struct_size = sizeof options, .shaders = {&shaders, 1}, .draws = DRAWS, .draw_count = sizeof DRAWS / sizeof *DRAWS,
        .custom_passes = {&custom, 1}};
    FramewrightRenderer *renderer;
    check(framewright_renderer_open_carried(own.device, "objects.ron", PIPELINE, &options, &renderer));
    check(framewright_renderer_set_extent(renderer, SIZE, SIZE));
    FAILS(framewright_renderer_frame(renderer, NULL), MISTAKES, "no recorder was set");
    check(framewright_renderer_set_recorder(renderer, record, &program));
    uint64_t frame;
    check(framewright_renderer_frame(renderer, NULL));
    HOLDS(program.calls == 5);
    compare_all(renderer);

    /* Groups may be freed as soon as the frame is recorded. */
    check(framewright_renderer_submit(renderer, NULL, &frame));
    framewright_bind_group_free(program.camera_group);
    framewright_bind_group_free(program.material_group);
    check(framewright_renderer_wait(renderer, frame));
    compare_all(renderer);

    framewright_renderer_free(renderer);
    for (int number = 0; number < 2; ++number) {
        free_view(&own, views[number]);
        free_image(&own, images[number]);
    }
    free_buffer(&own, program.places);
    free_buffer(&own, program.instances);
    free_buffer(&own, program.indices);
    free_buffer(&own, program.camera);
    free_buffer(&own, program.materials);
    close_device(&own);
    close_vulkan(&own);
    return EXIT_SUCCESS;
}
