/* Draw interfaces, bind groups and draws that are wrong: each is told, and the frame behind it is fine. Has a folder to write in. */

#include "testing.h"
#include <math.h>

static const char PIPELINE[] =
    "Pipeline(version: 1,\n"
    "    images: [(name: \"screen\", format: R8G8B8A8_UNORM, size: Output)],\n"
    "    passes: [(name: \"objects\", draw: Objects(Opaque), shader: \"object\", color: [(image: \"screen\", clear: (0.0, 0.0, 0.0, 0.0))])],\n"
    "    outputs: [\"screen\"])\n";
static const char VERTICES[] =
    "#version 460\n"
    "layout(location = 0) in vec2 place;\n"
    "layout(set = 1, binding = 0) uniform Camera { vec4 shift; } camera;\n"
    "void main() { gl_Position = vec4(place + camera.shift.xy, 0.0, 1.0); }\n";
static const char COLOR[] =
    "#version 460\n"
    "layout(set = 1, binding = 1) uniform sampler2D tint;\n"
    "layout(push_constant) uniform Object { vec4 color; } object;\n"
    "layout(location = 0) out vec4 color;\n"
    "void main() { color = object.color * texture(tint, vec2(0.5)); }\n";

/* Counts that were never set, or that count something else. */
static const size_t too_many[] = {SIZE_MAX, SIZE_MAX / 2, SIZE_MAX / 8, UINT32_MAX, 1u << 20};
#define COUNTS (sizeof too_many / sizeof *too_many)

static const FramewrightVertexBuffer BUFFER = {.stride = 8};
static const FramewrightAttribute PLACE = {.name = "place", .format = VK_FORMAT_R32G32_SFLOAT};
static const VkPushConstantRange PUSHED = {0, 0, 16};
static const FramewrightSuppliedResource SUPPLIED[] = {
    {.name = "camera", .set = 1, .binding = 0, .kind = FRAMEWRIGHT_RESOURCE_KIND_UNIFORM_BLOCK},
    {.name = "tint", .set = 1, .binding = 1, .kind = FRAMEWRIGHT_RESOURCE_KIND_SAMPLED_IMAGE}};
static const FramewrightDrawInterface RIGHT = {
    .draw = FRAMEWRIGHT_DRAW_OPAQUE, .vertex_buffers = &BUFFER, .vertex_buffer_count = 1, .attributes = &PLACE, .attribute_count = 1,
    .push_constants = &PUSHED, .push_constant_count = 1, .supplied = SUPPLIED, .supplied_count = 2};

static const OwnDevice *device_of;

/* Fails to open a renderer with these draws, with these words. */
static void refused(int line, const FramewrightDrawInterface *draws, size_t count, const char *words) {
    FramewrightRendererOptions options = {.struct_size = sizeof options, .draws = draws, .draw_count = count};
    FramewrightRenderer *none;
    fails(line, framewright_renderer_open_carried(device_of->device, "bad.ron", PIPELINE, &options, &none),
          FRAMEWRIGHT_STATUS_MISUSE, words);
    HOLDS(none == NULL);
}

#define REFUSED(draws, count, words) refused(__LINE__, draws, count, words)

/* The right interface with one change. */
#define CHANGED(words, change) \
    do { \
        FramewrightDrawInterface changed = RIGHT; \
        change; \
        REFUSED(&changed, 1, words); \
    } while (0)

static void interfaces(void) {
    CHANGED("there is no `draws[0].draw` of the number 10", changed.draw = 10);
    CHANGED("there is no `draws[0].draw` of the number 4294967295", changed.draw = UINT32_MAX);
    CHANGED("a name of custom passes, and the kind is `Objects(Opaque)`", changed.custom = "grass");
    CHANGED("`draws[0].custom` is no UTF-8", changed.custom = "\xff");
    CHANGED("draws of the kind `Compute` bring no such", changed.draw = FRAMEWRIGHT_DRAW_COMPUTE);
    CHANGED("draws of the kind `FullScreen` bring no such", changed.draw = FRAMEWRIGHT_DRAW_FULL_SCREEN);
    CHANGED("draws of the kind `Vertices` bring no such", changed.draw = FRAMEWRIGHT_DRAW_VERTICES);
    CHANGED("there is no `draws[0].topology` of the number 6",
            changed.has_topology = 1; changed.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY);
    CHANGED("there is no `draws[0].topology`", changed.has_topology = 1; changed.topology = (VkPrimitiveTopology)-1);
    CHANGED("strips that an index begins anew", changed.primitive_restart = 1);
    CHANGED("`draws[0].vertex_buffers` is NULL", changed.vertex_buffers = NULL);
    CHANGED("`draws[0].attributes` is NULL", changed.attributes = NULL);
    CHANGED("`draws[0].push_constants` is NULL", changed.push_constants = NULL);
    CHANGED("`draws[0].supplied` is NULL", changed.supplied = NULL);
    CHANGED("`draws[0].supplied` is no pointer", changed.supplied = (const FramewrightSuppliedResource *)1);
    for (size_t i = 0; i < COUNTS; ++i) {
        CHANGED("`draws[0].vertex_buffers` has ", changed.vertex_buffer_count = too_many[i]);
        CHANGED("`draws[0].attributes` has ", changed.attribute_count = too_many[i]);
        CHANGED("`draws[0].push_constants` has ", changed.push_constant_count = too_many[i]);
        CHANGED("`draws[0].supplied` has ", changed.supplied_count = too_many[i]);
        REFUSED(&RIGHT, too_many[i], "`draws` has ");
    }
    REFUSED(NULL, 1, "`draws` is NULL");
    const FramewrightDrawInterface twice[] = {RIGHT, RIGHT};
    REFUSED(twice, 2, "`draws[1]`: `Objects(Opaque)` stands here twice");
    const FramewrightDrawInterface named[] = {
        {.draw = FRAMEWRIGHT_DRAW_CUSTOM, .custom = "grass"}, {.draw = FRAMEWRIGHT_DRAW_CUSTOM, .custom = "grass"}};
    REFUSED(named, 2, "`draws[1]`: `grass` stands here twice");
    const char *custom = "gra\nss";
    FramewrightRendererOptions options = {
        .struct_size = sizeof options, .draws = named, .draw_count = 1, .custom_passes = {&custom, 1}};
    FramewrightRenderer *none;
    FAILS(framewright_renderer_open(device_of->device, "forward", &options, &none), MISUSE, "no custom pass is called `grass`");
    options.custom_passes.count = SIZE_MAX;
    FAILS(framewright_renderer_open(device_of->device, "forward", &options, &none), MISUSE, "`custom_passes` has ");
}

/* The right interface with another part. */
#define OTHER(type, part, count, words, ...) \
    do { \
        const type other = __VA_ARGS__; \
        CHANGED(words, changed.part = &other; changed.count = 1); \
    } while (0)
#define BUFFER_OF(words, ...) OTHER(FramewrightVertexBuffer, vertex_buffers, vertex_buffer_count, words, __VA_ARGS__)
#define ATTRIBUTE(words, ...) OTHER(FramewrightAttribute, attributes, attribute_count, words, __VA_ARGS__)
#define RANGE(words, ...) OTHER(VkPushConstantRange, push_constants, push_constant_count, words, __VA_ARGS__)
#define RESOURCE(words, ...) OTHER(FramewrightSuppliedResource, supplied, supplied_count, words, __VA_ARGS__)

static void parts(void) {
    BUFFER_OF("the vertices of buffer 0 have no bytes", {.stride = 0});
    BUFFER_OF("doesn't fit vertices of 4 bytes", {.stride = 4});
    BUFFER_OF("more instances than every device allows", {.stride = 8, .instances = UINT32_MAX});
    ATTRIBUTE("attributes[0].name` is NULL", {.format = VK_FORMAT_R32_SFLOAT});
    ATTRIBUTE("attributes[0].name` is no UTF-8", {.name = "a\xff", .format = VK_FORMAT_R32_SFLOAT});
    ATTRIBUTE("`` can't be a name in shaders", {.name = "", .format = VK_FORMAT_R32_SFLOAT});
    /* What would move a cursor or turn a line is shown and does nothing. */
    ATTRIBUTE("`a\\n\\u{1b}[1m\\u{202e}b` can't be a name", {.name = "a\n\033[1m\xe2\x80\xae" "b", .format = VK_FORMAT_R32_SFLOAT});
    ATTRIBUTE("no vertex attribute has the `format` of the number 0", {.name = "place"});
    ATTRIBUTE("the `format` of the number 111", {.name = "place", .format = VK_FORMAT_R64_SINT});
    ATTRIBUTE("the `format` of the number -1", {.name = "place", .format = (VkFormat)-1});
    ATTRIBUTE("is in vertex buffer 4294967295", {.name = "place", .format = VK_FORMAT_R32_SFLOAT, .buffer = UINT32_MAX});
    ATTRIBUTE("doesn't fit vertices of 8 bytes", {.name = "place", .format = VK_FORMAT_R32_SFLOAT, .offset = UINT32_MAX});
    ATTRIBUTE("multiples of 4 bytes", {.name = "place", .format = VK_FORMAT_R32_SFLOAT, .offset = 2});
    ATTRIBUTE("doesn't fit vertices", {.name = "place", .format = VK_FORMAT_R32_SFLOAT, .locations = UINT32_MAX});
    RANGE("0 bytes of push constants", {0, 0, 0});
    RANGE("3 bytes of push constants", {0, 0, 3});
    RANGE("4294967292 bytes of push constants from byte 8", {0, 8, UINT32_MAX - 3});
    RANGE("are for the stages `Vertex` and `Fragment`", {VK_SHADER_STAGE_COMPUTE_BIT, 0, 4});
    RANGE("are for vertex and fragment shaders", {VK_SHADER_STAGE_ALL, 0, 4});
    RESOURCE("supplied[0].name` is NULL", {.set = 1});
    RESOURCE("can't be a name in shaders", {.name = "ca mera", .set = 1});
    RESOURCE("there is no `draws[0].supplied[0].kind` of the number 3", {.name = "camera", .set = 1, .kind = 3});
    RESOURCE("can't be brought along in set 0", {.name = "camera"});
    RESOURCE("can't be brought along in set 4294967295", {.name = "camera", .set = UINT32_MAX});
    RESOURCE("bindings go up to 255", {.name = "camera", .set = 1, .binding = 256});
    RESOURCE("as only a `SampledImage` can be", {.name = "camera", .set = 1, .count = 2});
    /* More than the device has is an error of the frame. */
    const FramewrightSuppliedResource many = {
        .name = "tint", .set = 1, .binding = 1, .kind = FRAMEWRIGHT_RESOURCE_KIND_SAMPLED_IMAGE, .count = UINT32_MAX};
    FramewrightDrawInterface brought = RIGHT;
    brought.supplied = &many;
    brought.supplied_count = 1;
    FramewrightBindGroup *none;
    FAILS(framewright_bind_group_open(device_of->device, &brought, 1, NULL, 0, &none), MISUSE, "4294967295");
}

static void groups(const OwnBuffer *buffer, const VkDescriptorImageInfo *image) {
    FramewrightBindGroup *none;
    const FramewrightDevice *device = device_of->device;
    const VkDescriptorBufferInfo whole = {buffer->buffer, 0, 16};
    const FramewrightBinding right[] = {{.binding = 0, .buffer = &whole}, {.binding = 1, .images = image, .image_count = 1}};
    FAILS(framewright_bind_group_open(NULL, &RIGHT, 1, right, 2, &none), MISUSE, "`device` is NULL");
    FAILS(framewright_bind_group_open(device, NULL, 1, right, 2, &none), MISUSE, "`brought` is NULL");
    FAILS(framewright_bind_group_open(device, &RIGHT, 1, right, 2, NULL), MISUSE, "`group` is NULL");
    FAILS(framewright_bind_group_open(device, &RIGHT, 0, right, 2, &none), MISUSE, "it belongs to the pass");
    FAILS(framewright_bind_group_open(device, &RIGHT, 3, right, 2, &none), MISUSE, "has no binding 0");
    FAILS(framewright_bind_group_open(device, &RIGHT, UINT32_MAX, right, 2, &none), MISUSE, "has no binding 0");
    FAILS(framewright_bind_group_open(device, &RIGHT, 1, right, 1, &none), MISUSE, "`tint` is needed once and was given 0 times");
    FAILS(framewright_bind_group_open(device, &RIGHT, 1, NULL, 2, &none), MISUSE, "`bindings` is NULL");
    for (size_t i = 0; i < COUNTS; ++i) {
        FAILS(framewright_bind_group_open(device, &RIGHT, 1, right, too_many[i], &none), MISUSE, "`bindings` has ");
        const FramewrightBinding images = {.binding = 1, .images = image, .image_count = too_many[i]};
        FAILS(framewright_bind_group_open(device, &RIGHT, 1, &images, 1, &none), MISUSE, "`images` has ");
    }
    HOLDS(none == NULL);
    struct {
        VkDescriptorBufferInfo buffer;
        const char *words;
    } buffers[] = {{{VK_NULL_HANDLE, 0, 16}, "the buffer is VK_NULL_HANDLE"}, {{buffer->buffer, 1, 16}, "the offset 1 is no multiple"},
                   {{buffer->buffer, 0, 0}, "0 bytes of a buffer"}, {{buffer->buffer, 0, VK_WHOLE_SIZE}, "18446744073709551615 bytes"}};
    for (size_t i = 0; i < 4; ++i) {
        const FramewrightBinding wrong[] = {{.binding = 0, .buffer = &buffers[i].buffer}, right[1]};
        FAILS(framewright_bind_group_open(device, &RIGHT, 1, wrong, 2, &none), MISUSE, buffers[i].words);
    }
    VkDescriptorImageInfo odd = *image;
    FramewrightBinding wrong[] = {right[0], {.binding = 1, .images = &odd, .image_count = 1}};
    odd.imageLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    FAILS(framewright_bind_group_open(device, &RIGHT, 1, wrong, 2, &none), MISUSE, "is none that an image is read in");
    odd = *image;
    odd.imageView = VK_NULL_HANDLE;
    FAILS(framewright_bind_group_open(device, &RIGHT, 1, wrong, 2, &none), MISUSE, "a view or sampler of `tint` is VK_NULL_HANDLE");
    odd = *image;
    odd.sampler = VK_NULL_HANDLE;
    FAILS(framewright_bind_group_open(device, &RIGHT, 1, wrong, 2, &none), MISUSE, "a view or sampler of `tint` is VK_NULL_HANDLE");
    odd = *image;
    wrong[1].buffer = &whole;
    FAILS(framewright_bind_group_open(device, &RIGHT, 1, wrong, 2, &none), MISUSE, "binding 1 has a `buffer` and `images`");
    wrong[1] = (FramewrightBinding){.binding = 1};
    FAILS(framewright_bind_group_open(device, &RIGHT, 1, wrong, 2, &none), MISUSE, "binding 1 has neither");
    wrong[1] = (FramewrightBinding){.binding = 1, .buffer = &whole};
    FAILS(framewright_bind_group_open(device, &RIGHT, 1, wrong, 2, &none), MISUSE, "something else was given");
    const VkDescriptorImageInfo two[] = {*image, *image};
    wrong[1] = (FramewrightBinding){.binding = 1, .images = two, .image_count = 2};
    FAILS(framewright_bind_group_open(device, &RIGHT, 1, wrong, 2, &none), MISUSE, "`tint` takes 1 views and was given 2");
    framewright_bind_group_free(NULL);
}

/* What is left out or wrong in a frame. */
typedef enum {
    NOTHING, NO_GROUP, WRONG_GROUP, NO_SUCH_SET, NO_VERTICES, NO_SUCH_BUFFER, NULL_VERTICES, ODD_OFFSET, NO_BYTES, SHORT_VERTICES, NO_INDICES,
    SHORT_INDICES, ODD_INDICES, NO_CONSTANTS, MANY_CONSTANTS, ODD_CONSTANTS, ODD_VIEWPORT, NULL_SET,
    FAULTS
} Fault;

static const char *const WORDS[FAULTS] = {
    "", "a draw without a bind group for set 1", "was made for another set than 1", "the draw interface has no set 3", "a draw without vertex buffer",
    "no vertex buffer 1", "vertex buffer 0: the buffer is VK_NULL_HANDLE", "the offset 2 is no multiple of 4", "0 bytes from byte 0",
    "vertices 0 to 2 lie beyond the vertex buffer", "an indexed draw without index buffer", "beyond the index buffer, which holds 2",
    "the index buffer: the offset 1 is no multiple of 2", "a draw without all push constants of `object`", "20 bytes of push constants",
    "3 bytes of push constants", "a viewport of ", "set 1 is the draw source's"};

typedef struct {
    OwnBuffer vertices, indices;
    FramewrightBindGroup *group, *other;
    Fault fault;
} Program;

/* Wrong calls that are told at once. */
static void misuse(const Program *program, const FramewrightPass *pass) {
    FAILS(framewright_pass_bind_group(NULL, 1, program->group), MISUSE, "`pass` is NULL");
    FAILS(framewright_pass_bind_group(pass, 1, NULL), MISUSE, "`group` is NULL");
    FAILS(framewright_pass_bind_set(pass, 1, VK_NULL_HANDLE, NULL, 1), MISUSE, "`offsets` is NULL");
    FAILS(framewright_pass_bind_vertex_buffer(NULL, 0, VK_NULL_HANDLE, 0, 0), MISUSE, "`pass` is NULL");
    FAILS(framewright_pass_bind_index_buffer(pass, program->indices.buffer, 0, 6, VK_INDEX_TYPE_NONE_KHR), MISUSE, "there is no `type_of_index`");
    FAILS(framewright_pass_push_constants(pass, 0, NULL, 16), MISUSE, "`constants` is NULL");
    FAILS(framewright_pass_push_constants(pass, 0, &PUSHED, SIZE_MAX), MISUSE, "`constants` has ");
    FAILS(framewright_pass_set_cull_mode(pass, 4), MISUSE, "there is no `mode` of the number 4");
    FAILS(framewright_pass_set_front_face(pass, (VkFrontFace)2), MISUSE, "there is no `face` of the number 2");
    FAILS(framewright_pass_set_viewport(NULL, 0, 0, 1, 1), MISUSE, "`pass` is NULL");
    FAILS(framewright_pass_set_scissor(NULL, 0, 0, 1, 1), MISUSE, "`pass` is NULL");
    FAILS(framewright_pass_draw_indexed(pass, UINT32_MAX, 1, 0, 0, 1), MISUSE, "too many indices");
    FAILS(framewright_pass_draw_indexed(pass, 0, 3, 0, 1, UINT32_MAX), MISUSE, "too many instances");
    const FramewrightPass made = {.name = "objects"};
    FAILS(framewright_pass_bind_group(&made, 1, program->group), MISUSE, "`pass->resources` is NULL");
    double number;
    size_t count = 1;
    FAILS(framewright_pass_param(pass, NULL, &number, &count), MISUSE, "`name` is NULL");
}

static uint32_t record(void *context, const FramewrightPass *pass) {
    const Program *program = context;
    const Fault fault = program->fault;
    const float color[] = {1, 1, 1, 1, 1};
    misuse(program, pass);
    if (fault != NO_GROUP) {
        check(framewright_pass_bind_group(pass, fault == NO_SUCH_SET ? 3 : 1, fault == WRONG_GROUP ? program->other : program->group));
    }
    if (fault == NULL_SET) {
        check(framewright_pass_bind_set(pass, 1, VK_NULL_HANDLE, NULL, 0));
    }
    if (fault != NO_VERTICES) {
        check(framewright_pass_bind_vertex_buffer(
            pass, fault == NO_SUCH_BUFFER, fault == NULL_VERTICES ? VK_NULL_HANDLE : program->vertices.buffer, fault == ODD_OFFSET ? 2 : 0,
            fault == NO_BYTES ? 0 : fault == SHORT_VERTICES ? 16 : 24));
    }
    if (fault != NO_INDICES) {
        check(framewright_pass_bind_index_buffer(
            pass, program->indices.buffer, fault == ODD_INDICES, fault == SHORT_INDICES ? 4 : 6, VK_INDEX_TYPE_UINT16));
    }
    if (fault != NO_CONSTANTS) {
        const size_t bytes = fault == MANY_CONSTANTS ? 20 : fault == ODD_CONSTANTS ? 3 : 16;
        check(framewright_pass_push_constants(pass, 0, color, bytes));
    }
    if (fault == ODD_VIEWPORT) {
        check(framewright_pass_set_viewport(pass, NAN, 0, 1, INFINITY));
    }
    check(framewright_pass_set_scissor(pass, UINT32_MAX, 0, UINT32_MAX, UINT32_MAX));
    check(framewright_pass_draw_indexed(pass, 0, 3, 0, 0, 1));
    check(framewright_pass_set_scissor(pass, 0, 0, UINT32_MAX, UINT32_MAX));
    check(framewright_pass_draw(pass, 0, 3, 0, 1));
    return 1;
}

int main(void) {
    write_file("object.vert", VERTICES);
    write_file("object.frag", COLOR);
    OwnDevice own;
    open_vulkan(&own);
    open_device(&own, NULL);
    device_of = &own;
    interfaces();
    parts();

    const float places[] = {-1, -1, 3, -1, -1, 3}, shift[] = {0, 0, 0, 0};
    const uint16_t indices[] = {0, 1, 2};
    OwnBuffer camera = filled_buffer(&own, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, shift, sizeof shift);
    OwnImage image = own_texel(&own, (VkClearColorValue){.float32 = {1, 1, 1, 1}});
    VkDescriptorImageInfo view = own_view(&own, image);
    groups(&camera, &view);

    Program program = {
        .vertices = filled_buffer(&own, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, places, sizeof places),
        .indices = filled_buffer(&own, VK_BUFFER_USAGE_INDEX_BUFFER_BIT, indices, sizeof indices)};
    const VkDescriptorBufferInfo whole = {camera.buffer, 0, 16};
    const FramewrightBinding bindings[] = {{.binding = 0, .buffer = &whole}, {.binding = 1, .images = &view, .image_count = 1}};
    check(framewright_bind_group_open(own.device, &RIGHT, 1, bindings, 2, &program.group));
    const FramewrightDrawInterface other = {.draw = FRAMEWRIGHT_DRAW_OPAQUE, .supplied = SUPPLIED, .supplied_count = 1};
    check(framewright_bind_group_open(own.device, &other, 1, bindings, 1, &program.other));
    const char *shaders = ".";
    FramewrightRendererOptions options = {.struct_size = sizeof options, .shaders = {&shaders, 1}, .draws = &RIGHT, .draw_count = 1};
    FramewrightRenderer *renderer;
    check(framewright_renderer_open_carried(own.device, "bad.ron", PIPELINE, &options, &renderer));
    check(framewright_renderer_set_extent(renderer, 4, 4));
    FramewrightScene *scene;
    check(framewright_scene_load("spheres_and_cubes", &scene));
    FAILS(framewright_renderer_set_scene(renderer, scene), MISUSE, "`scene_draws`");
    check(framewright_renderer_set_scene(renderer, NULL));
    check(framewright_renderer_set_recorder(renderer, record, &program));
    for (Fault fault = NOTHING + 1; fault < FAULTS; ++fault) {
        program.fault = fault;
        fails(100 * fault, framewright_renderer_frame(renderer, NULL), FRAMEWRIGHT_STATUS_MISUSE, WORDS[fault]);
        program.fault = NOTHING;
        check(framewright_renderer_frame(renderer, NULL));
        FramewrightTexels texels;
        check(framewright_renderer_read(renderer, "screen", &texels));
        HOLDS(texels.bytes[0] == 255 && texels.bytes[texels.byte_count - 1] == 255);
    }

    /* What a shader reads and nobody brings is told with the shader's line. */
    FramewrightRenderer *lacking;
    FramewrightDrawInterface without = RIGHT;
    without.attribute_count = 0;
    options.draws = &without;
    check(framewright_renderer_open_carried(own.device, "bad.ron", PIPELINE, &options, &lacking));
    FAILS(framewright_renderer_frame(lacking, NULL), MISTAKES, "`place`");
    framewright_renderer_free(lacking);

    /* A scene may draw the other kinds. */
    options.draws = &RIGHT;
    options.scene_draws = 1;
    check(framewright_renderer_open_carried(own.device, "bad.ron", PIPELINE, &options, &lacking));
    check(framewright_renderer_set_scene(lacking, scene));
    check(framewright_renderer_set_recorder(lacking, record, &program));
    check(framewright_renderer_frame(lacking, NULL));

    /* The file of it, another renderer, and images that leave the frame. */
    const char *ron;
    check(framewright_renderer_interface(renderer, &ron));
    HOLDS(strstr(ron, "(name: \"place\", components: 2, offset: 0)") != NULL && strstr(ron, "Objects(Opaque)") != NULL);
    FAILS(framewright_renderer_interface(renderer, NULL), MISUSE, "`ron` is NULL");
    FramewrightRenderer *clone;
    check(framewright_renderer_clone(renderer, &clone));
    check(framewright_renderer_make_pipelines(clone));
    FAILS(framewright_renderer_frame(clone, NULL), MISTAKES, "no recorder was set");
    FAILS(framewright_renderer_clone(renderer, NULL), MISUSE, "`other` is NULL");
    FramewrightRenderer *none = clone;
    FAILS(framewright_renderer_clone(NULL, &none), MISUSE, "`renderer` is NULL");
    HOLDS(none == NULL);
    const char *dumped = "scren";
    FAILS(framewright_renderer_set_dump(renderer, &dumped, 1), MISTAKES, "`scren`");
    FAILS(framewright_renderer_set_dump(renderer, NULL, 1), MISUSE, "`images` is NULL");
    check(framewright_renderer_set_dump(renderer, NULL, 0));

    framewright_renderer_free(clone);
    framewright_renderer_free(lacking);
    framewright_renderer_free(renderer);
    framewright_scene_free(scene);
    framewright_bind_group_free(program.group);
    framewright_bind_group_free(program.other);
    free_view(&own, view);
    free_image(&own, image);
    free_buffer(&own, camera);
    free_buffer(&own, program.vertices);
    free_buffer(&own, program.indices);
    close_device(&own);
    close_vulkan(&own);
    return EXIT_SUCCESS;
}
