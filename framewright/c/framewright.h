// Framewright: a render graph for Vulkan 1.3. This header is made by cbindgen of the crate framewright-c; docs/c.md tells how to use it.
//
// - A function that can fail returns a status. `framewright_last_error` has the words, with file, line and column where a file is wrong.
// - Texts are UTF-8 and end with 0. What a pointer of an argument leads to is needed during the call alone, and must not be NULL unless
//   the function says so.
// - Handles are made by `…_open`, `…_open_carried`, `…_open_physical`, `…_adopt`, `…_load`, `…_serve`, `…_clone` and `framewright_renderer_device_features`, and
//   freed by the `…_free` of their kind, which takes NULL. What was made from a handle outlives it.
// - A structure that begins with `struct_size` is set to 0 but for that: `FramewrightDeviceOptions options = {.struct_size = sizeof options}`.
// - Vulkan's handles belong to the program, and are as its Vulkan demands: of the same device, alive, and in the state that is told.

#ifndef FRAMEWRIGHT_H
#define FRAMEWRIGHT_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

// The version of this interface. A program that was compiled with another one than `framewright_abi` returns must not call anything else.
#define FRAMEWRIGHT_ABI 2

// What became of a call. `framewright_last_error` has the words.
typedef enum {
    // All went well.
    FRAMEWRIGHT_STATUS_OK = 0,
    // The call is wrong: a pointer is NULL, a text isn't UTF-8, a structure has another size, a name isn't known, or it isn't the time.
    FRAMEWRIGHT_STATUS_MISUSE = 1,
    // A file is missing, or can't be read.
    FRAMEWRIGHT_STATUS_FILE = 2,
    // The user's files or choices are wrong. `framewright_last_mistake` has the mistakes one by one.
    FRAMEWRIGHT_STATUS_MISTAKES = 3,
    // The machine lacks something: a driver, a device, a feature, the validation layer.
    FRAMEWRIGHT_STATUS_MACHINE = 4,
    // There is not enough memory.
    FRAMEWRIGHT_STATUS_OUT_OF_MEMORY = 5,
    // The device is lost, or didn't answer in time: nothing that was made from it can be used any more.
    FRAMEWRIGHT_STATUS_DEVICE_LOST = 6,
    // The library has a mistake, and a call panicked. The handle that was used can only be freed.
    FRAMEWRIGHT_STATUS_PANIC = 7,
} FramewrightStatus;

// What a pass draws that the program records.
typedef enum {
    // What the program knows by the name behind `custom`; also what it records outside of rendering scopes.
    FRAMEWRIGHT_DRAW_CUSTOM = 0,
    // Opaque objects.
    FRAMEWRIGHT_DRAW_OPAQUE = 1,
    // Objects with holes.
    FRAMEWRIGHT_DRAW_MASKED = 2,
    // Objects that let light through.
    FRAMEWRIGHT_DRAW_TRANSPARENT = 3,
    // Opaque objects as the sun sees them.
    FRAMEWRIGHT_DRAW_OPAQUE_CASTERS = 4,
    // Objects with holes as the sun sees them.
    FRAMEWRIGHT_DRAW_MASKED_CASTERS = 5,
    // The sky.
    FRAMEWRIGHT_DRAW_SKY = 6,
    // A full-screen pass whose shader reads what the program's draws bring along: three vertices and no buffer of them.
    FRAMEWRIGHT_DRAW_FULL_SCREEN = 7,
    // A pass's own vertices, whose shader reads what the program's draws bring along: the program only binds, and the draw follows by itself.
    FRAMEWRIGHT_DRAW_VERTICES = 8,
    // A compute pass whose shader reads the same: the program only binds, `commands` is NULL, and the dispatch follows by itself.
    FRAMEWRIGHT_DRAW_COMPUTE = 9,
} FramewrightDraw;

// An eye.
typedef enum {
    // None of two: there is one, or both are meant.
    FRAMEWRIGHT_EYE_NONE = 0,
    // The left one.
    FRAMEWRIGHT_EYE_LEFT = 1,
    // The right one.
    FRAMEWRIGHT_EYE_RIGHT = 2,
} FramewrightEye;

// How one image holds both eyes' parts, the left one's first.
typedef enum {
    // It doesn't: it is one picture.
    FRAMEWRIGHT_EYE_FORM_NONE = 0,
    // In two layers.
    FRAMEWRIGHT_EYE_FORM_LAYERS = 1,
    // Side by side.
    FRAMEWRIGHT_EYE_FORM_HALVES = 2,
} FramewrightEyeForm;

// What became another one when a frame was prepared.
typedef enum {
    // Nothing: nothing was planned.
    FRAMEWRIGHT_CHANGE_NOTHING = 0,
    // At most numbers in the Plan.
    FRAMEWRIGHT_CHANGE_VALUES = 1,
    // The Plan: images that the program imported are to be imported again.
    FRAMEWRIGHT_CHANGE_PLAN = 2,
} FramewrightChange;

// How a frame is drawn for two eyes.
typedef enum {
    // For one eye.
    FRAMEWRIGHT_STEREO_OFF = 0,
    // Two images, one after the other.
    FRAMEWRIGHT_STEREO_MULTI_PASS = 1,
    // Halves of one image of twice the width.
    FRAMEWRIGHT_STEREO_DOUBLE_WIDE = 2,
    // Layers of one image, or halves where vertex shaders can't choose a layer; each draw has twice the instances.
    FRAMEWRIGHT_STEREO_INSTANCED = 3,
    // Layers of one image, into all of which the device draws.
    FRAMEWRIGHT_STEREO_MULTIVIEW = 4,
} FramewrightStereo;

// By how much the screen is turned that shows a picture, clockwise.
typedef enum {
    // Not at all.
    FRAMEWRIGHT_ROTATION_IDENTITY = 0,
    // A quarter.
    FRAMEWRIGHT_ROTATION_ROTATE90 = 1,
    // A half.
    FRAMEWRIGHT_ROTATION_ROTATE180 = 2,
    // Three quarters.
    FRAMEWRIGHT_ROTATION_ROTATE270 = 3,
} FramewrightRotation;

// Who else than this device has an image or buffer between frames.
typedef enum {
    // Nobody: the queues of the device.
    FRAMEWRIGHT_OWNER_DEVICE = 0,
    // Another device of Vulkan, of the same driver (`VK_QUEUE_FAMILY_EXTERNAL`).
    FRAMEWRIGHT_OWNER_EXTERNAL = 1,
    // Anything else (`VK_QUEUE_FAMILY_FOREIGN_EXT`). The device must have `VK_EXT_queue_family_foreign` on.
    FRAMEWRIGHT_OWNER_FOREIGN = 2,
} FramewrightOwner;

// The kind of a resource that draws bring along.
typedef enum {
    // A uniform block.
    FRAMEWRIGHT_RESOURCE_KIND_UNIFORM_BLOCK = 0,
    // A storage block that shaders read (`readonly buffer`).
    FRAMEWRIGHT_RESOURCE_KIND_STORAGE_BLOCK = 1,
    // A two-dimensional image of floats with its sampler (`sampler2D`), or an array of such ones.
    FRAMEWRIGHT_RESOURCE_KIND_SAMPLED_IMAGE = 2,
} FramewrightResourceKind;

// A set of a draw interface, filled. Any thread may use it, and several at once. It is freed whenever the program likes: frames on their way
// keep what they need of it.
typedef struct FramewrightBindGroup FramewrightBindGroup;

// A device. Any thread may use it, and several at once. It closes when it and all that was made from it are freed.
typedef struct FramewrightDevice FramewrightDevice;

// Features and extensions for a device that the program makes, and has the library use.
typedef struct FramewrightFeatures FramewrightFeatures;

// A pipeline that is drawn frame after frame. One thread at a time uses it; it need not be the same one.
typedef struct FramewrightRenderer FramewrightRenderer;

// What a pass accesses.
typedef struct FramewrightResources FramewrightResources;

// A scene in memory. Any thread may use it, and several at once.
typedef struct FramewrightScene FramewrightScene;

// A page that shows a running program, as long as this handle is there. One thread at a time uses it.
typedef struct FramewrightViewer FramewrightViewer;

// One mistake in the user's files or choices.
typedef struct {
    // The mistake, in one sentence.
    const char *message;
    // The file, relative to the folder of the pipeline; NULL if no file is to blame, and the numbers are 0.
    const char *file;
    // The line, from 1.
    uint32_t line;
    // The column in characters, from 1.
    uint32_t column;
    // The stable code of the rule that is broken, such as "E0207": docs/codes.md explains it.
    const char *code;
} FramewrightMistake;

// How to open a device. 0 in a field is its default.
typedef struct {
    // sizeof(FramewrightDeviceOptions).
    size_t struct_size;
    // Its name, or a part of it or of its driver's name; NULL: lavapipe, or where there is none, the first device that will do.
    const char *name;
    // Whether the validation layer watches: see `framewright_device_findings`.
    uint32_t validation;
    // A program whose `main` calls `helper::serve`, such as the command `framewright`: shaders are compiled and drivers tested in
    // it, and can't end this one. NULL: in this process, which is for shaders and drivers that are trusted.
    const char *helper;
    // Whether the device leaves draws and shaders unchecked: `robustBufferAccess` is off. Then no index of a draw, an indirect draw or a
    // shader may reach beyond its buffer: for programs that draw files and shaders of their own alone. 0: it keeps them within.
    uint32_t unchecked_bounds;
} FramewrightDeviceOptions;

// Vulkan's handles of a device.
typedef struct {
    // The instance.
    VkInstance instance;
    // The physical device.
    VkPhysicalDevice physical_device;
    // The device.
    VkDevice device;
    // The queue family that frames are for. Of a device of the library's its queue number 0 is used.
    uint32_t queue_family;
} FramewrightVulkan;

// Is told a finding of the validation layer, which lives until it returns: the layer's words, behind the step and pass where the layer
// knows them.
typedef void (*FramewrightFinding)(void *context, const char *text);

// Is told an image of the library's that died.
typedef void (*FramewrightDeadImage)(void *context, VkImage image);

// Several texts.
typedef struct {
    // The first of them; NULL if there are none.
    const char *const *names;
    // How many there are.
    size_t count;
} FramewrightNames;

// A queue that the library may use.
typedef struct {
    // Its family.
    uint32_t family;
    // The queue.
    VkQueue queue;
} FramewrightQueue;

// A device that the program made itself, and what it was made with. The instance has Vulkan 1.3 as its `apiVersion`, and comes from the
// system's loader.
typedef struct {
    // sizeof(FramewrightAdoptedDevice).
    size_t struct_size;
    // The instance.
    VkInstance instance;
    // The extensions that it was created with.
    FramewrightNames instance_extensions;
    // The physical device.
    VkPhysicalDevice physical_device;
    // The device.
    VkDevice device;
    // The extensions that it was created with.
    FramewrightNames device_extensions;
    // The features that it was created with, as they were chained to its creation. What is missing is named by the error.
    const VkPhysicalDeviceFeatures2 *features;
    // Queues that the library may use, of which one does graphics and compute. While a call of the library draws, uploads or reads back,
    // no other thread submits to them.
    const FramewrightQueue *queues;
    // How many there are.
    size_t queue_count;
    // As in FramewrightDeviceOptions.
    const char *helper;
} FramewrightAdoptedDevice;

// Where the picture of an eye lies in what a pass draws into.
typedef struct {
    // The viewport of all of it.
    VkViewport viewport;
    // The scissor of the same: what lies outside is the other eye's.
    VkRect2D scissor;
    // The layer of the attachments. With a view mask the device chooses it, and `gl_ViewIndex` is its number; without one, a vertex shader
    // does so (`gl_Layer`).
    uint32_t layer;
} FramewrightEyeTarget;

// What pipelines of the program's own must fit to be bound in a pass within a rendering scope.
typedef struct {
    // Formats of the colour attachments.
    const VkFormat *color;
    // How many there are.
    uint32_t color_count;
    // The format of the depth attachment; `VK_FORMAT_UNDEFINED` if there is none.
    VkFormat depth;
    // The format of the stencil attachment; `VK_FORMAT_UNDEFINED` if there is none.
    VkFormat stencil;
    // Samples of each attachment: a `VkSampleCountFlagBits`.
    VkSampleCountFlags samples;
    // Views that are drawn at once, a bit for each; 0 where there are none.
    uint32_t view_mask;
    // For each colour attachment the location at which the pass writes it (`VkRenderingAttachmentLocationInfoKHR`); NULL: its own number.
    const uint32_t *locations;
    // For each colour attachment the number of its input attachment (`VkRenderingInputAttachmentIndexInfoKHR`); NULL: its own number.
    const uint32_t *inputs;
} FramewrightFormats;

// A pass that is to be recorded. It lives until its callback returns.
typedef struct {
    // The name of the pass.
    const char *name;
    // What the pipeline calls its work: the name behind `custom`. Of other draws, the name of their shader.
    const char *custom;
    // Where it is recorded. Its barriers are there already. NULL for a compute pass.
    VkCommandBuffer commands;
    // Whether it stands inside a rendering scope with the pass's targets, which is left open; else it stands outside of one.
    uint32_t in_scope;
    // Width of the targets; where the pass is for both eyes, of one eye's picture; 0 outside of a scope.
    uint32_t width;
    // Height of the same; 0 outside of a scope.
    uint32_t height;
    // The number of the frame, as `framewright_renderer_frame` returns it.
    uint64_t frame;
    // Leads all functions of the name `framewright_pass_…` to the pass.
    const FramewrightResources *resources;
    // The queue family that the commands are for: that for graphics, or that for compute if the pipeline says `queue: Any`. For a compute pass, whose
    // `commands` is NULL, it is `VK_QUEUE_FAMILY_IGNORED`.
    uint32_t queue_family;
    // What it draws.
    FramewrightDraw draw;
    // The eye that it is recorded for, where it is recorded for each eye by itself.
    FramewrightEye eye;
    // The FramewrightStereo in which it is recorded for both eyes at once; `FRAMEWRIGHT_STEREO_OFF` if it isn't.
    uint32_t both_eyes;
    // How images hold both eyes' parts, where it is recorded for both at once.
    FramewrightEyeForm eye_form;
    // Inside a scope for both eyes, where each eye's picture lies, the left one's first; else 0.
    FramewrightEyeTarget eye_targets[2];
    // Inside a scope, what pipelines of the program's must fit; NULL outside of one.
    const FramewrightFormats *formats;
    // For a pass of which `framewright_renderer_set_secondary` says that it has secondary command buffers, what they are begun with, beside
    // `RENDER_PASS_CONTINUE`; `commands` then takes `vkCmdExecuteCommands` and nothing else. NULL for other passes.
    const VkCommandBufferInheritanceRenderingInfo *inheritance;
    // The FramewrightRotation of the picture inside a scope: pipelines of the program's own turn what they draw.
    uint32_t rotation;
} FramewrightPass;

// An image that a pass accesses.
typedef struct {
    // Vulkan's image.
    VkImage image;
    // The part that the pass may touch.
    VkImageSubresourceRange range;
    // Width in texels of its first mip level, as much as is in use.
    uint32_t width;
    // Height in texels.
    uint32_t height;
    // Depth in texels: 1, but for a volume.
    uint32_t depth;
    // The layout that it is in, and is left in.
    VkImageLayout layout;
    // How it holds both eyes' parts: in two layers, which are in `range`, or side by side, of which `width` and `height` are one's.
    FramewrightEyeForm eye_form;
    // The eye whose part alone is meant, of an image that holds both eyes'.
    FramewrightEye eye;
} FramewrightPassImage;

// A vertex buffer of a draw interface.
typedef struct {
    // Bytes from element to element.
    uint32_t stride;
    // 0: it has an element for each vertex. Else how many instances in a row read one element: 1 for an element for each instance. More than 1
    // needs the feature `vertexAttributeInstanceRateDivisor`.
    uint32_t instances;
} FramewrightVertexBuffer;

// A vertex attribute of a draw interface. Shaders choose locations, and find attributes by name.
typedef struct {
    // Its name in shaders.
    const char *name;
    // Its format; of a matrix or an array that of one location.
    VkFormat format;
    // Where it lies in an element of the buffer, in bytes.
    uint32_t offset;
    // The number of its vertex buffer.
    uint32_t buffer;
    // How many locations it takes, one behind the other in the buffer: of a matrix as many as it has columns; 0 counts as 1.
    uint32_t locations;
    // Whether shaders that have no name for it read it at `location`. 0 is false.
    uint32_t has_location;
    // That location.
    uint32_t location;
} FramewrightAttribute;

// A resource of a draw interface. All stages of the shaders of its kind of draws see it.
typedef struct {
    // Its name in shaders.
    const char *name;
    // Its descriptor set, 1 to 3.
    uint32_t set;
    // Its binding, 0 to 255.
    uint32_t binding;
    // A FramewrightResourceKind.
    uint32_t kind;
    // How many images an array has; 0 counts as 1.
    uint32_t count;
} FramewrightSuppliedResource;

// What one kind of draws of the program's brings along: vertices, push constants, and resources in bind groups. 0 in a field is its default.
typedef struct {
    // The kind: a FramewrightDraw. Full-screen passes have no vertices of the program's; compute passes and draws of a pass's own vertices have no
    // push constants of it either.
    uint32_t draw;
    // With `FRAMEWRIGHT_DRAW_CUSTOM`: what the pipeline calls the custom passes that are meant, alone; NULL: all that no other entry means.
    const char *custom;
    // Vertex buffers, by their numbers.
    const FramewrightVertexBuffer *vertex_buffers;
    // How many there are.
    size_t vertex_buffer_count;
    // Vertex attributes.
    const FramewrightAttribute *attributes;
    // How many there are.
    size_t attribute_count;
    // Whether `topology` is what vertices make; else the pass says it, or it is a triangle of each three. 0 is false.
    uint32_t has_topology;
    // What vertices make: points, lines or triangles, without adjacency and patches.
    VkPrimitiveTopology topology;
    // Whether an index of all ones ends a strip or a fan, and begins another. 0 is false.
    uint32_t primitive_restart;
    // Push constants that the program sets for each draw. `stageFlags` of 0 are vertex and fragment shaders.
    const VkPushConstantRange *push_constants;
    // How many ranges there are.
    size_t push_constant_count;
    // Resources.
    const FramewrightSuppliedResource *supplied;
    // How many there are.
    size_t supplied_count;
} FramewrightDrawInterface;

// What is bound at a binding of a bind group: a buffer, or images.
typedef struct {
    // The number of the binding.
    uint32_t binding;
    // For a uniform or storage block, its buffer; else NULL. `range` is a number of bytes, and not `VK_WHOLE_SIZE`.
    const VkDescriptorBufferInfo *buffer;
    // For a sampled image, its view of the type 2D, its sampler and the layout that it is read in; for an array each of its elements; else NULL.
    const VkDescriptorImageInfo *images;
    // How many images there are.
    size_t image_count;
} FramewrightBinding;

// The layout of a descriptor set that the program makes and binds itself.
typedef struct {
    // Its number, 1 to 3. The draws of a scene have set 1 and set 2.
    uint32_t set;
    // Its bindings: types of buffers, texel buffers, images, samplers and acceleration structures, for vertex, fragment and compute shaders. Other stages take a
    // `layout`.
    const VkDescriptorSetLayoutBinding *bindings;
    // The flags of each binding; NULL: none has any.
    const VkDescriptorBindingFlags *flags;
    // How many bindings there are.
    size_t binding_count;
    // The layout that the program made so, which lives as long as the device; NULL: one is made of the bindings. Immutable samplers take one.
    VkDescriptorSetLayout layout;
} FramewrightSet;

// A file that the program carries within itself.
typedef struct {
    // Its name.
    const char *name;
    // What it holds.
    const void *bytes;
    // How many bytes, at most 16 MiB.
    size_t byte_count;
} FramewrightFile;

// What a renderer is made with, and keeps. 0 in a field is its default.
typedef struct {
    // sizeof(FramewrightRendererOptions).
    size_t struct_size;
    // How many frames may be on their way before a new one waits for the oldest, at most 16; 0 counts as 1.
    uint32_t frames_in_flight;
    // Folders of shaders beside that of the pipeline.
    FramewrightNames shaders;
    // Settings files, of which later ones are stronger.
    FramewrightNames settings;
    // Extensions that are applied to the pipeline: files, or paths of shipped ones.
    FramewrightNames extensions;
    // What the program's draws bring along, for each kind of draws at most once; the kinds that aren't listed bring nothing. If there are
    // none, all kinds bring what a scene does.
    const FramewrightDrawInterface *draws;
    // How many there are.
    size_t draw_count;
    // With `draws`: whether the kinds that aren't listed bring what a scene does, which then draws them. 0 is false.
    uint32_t scene_draws;
    // The names of all custom passes that the program records: others are mistakes of a pipeline. If there are none, any name is right.
    FramewrightNames custom_passes;
    // Descriptor sets that the program makes itself, and binds by `framewright_renderer_bind_set`.
    const FramewrightSet *sets;
    // How many there are.
    size_t set_count;
    // Commands that compile shaders in HLSL, Slang and WGSL, each with its language: `hlsl=dxc`, `slang=slangc -O0`. Later ones are
    // stronger. docs/hlsl.md has more.
    FramewrightNames shader_compilers;
    // Modules of SPIR-V, by the names of files that no folder has: a pipeline says `FullScreen("post.spv")`.
    const FramewrightFile *spirv;
    // How many there are.
    size_t spirv_count;
    // A folder of shaders that were compiled ahead; NULL: none. Others are compiled, where the library has a compiler.
    const char *precompiled;
    // Whether shaders that are compiled are added to that folder. 0 is false.
    uint32_t precompiled_adds;
    // In place of such a folder its files, by their names without folder.
    const FramewrightFile *precompiled_files;
    // How many there are.
    size_t precompiled_file_count;
    // The program hands addresses of buffers out in its sets, and vouches for the shaders that follow them. 0 is false.
    uint32_t addresses;
    // Whether what custom passes do is held against what the pipeline says of them, to look for mistakes: 1. A broken promise fails the call
    // that waits for the frame, or for room for another one, and the frame is done all the same. docs/embedding.md has more.
    uint32_t check_uses;
    // Whether Plans are for the queue for graphics alone, as `framewright_renderer_record_into` needs it of a device with several. 0 is false.
    uint32_t one_queue;
    // Whether the device notes each step that it begins: an error of a device that stopped names the step. It takes time. 0 is false.
    uint32_t breadcrumbs;
    // Whether each step is waited for before the next, to the same end. 0 is false.
    uint32_t step_by_step;
} FramewrightRendererOptions;

// What conditions of a pipeline ask for, for a program that knows its scene. 0 is false.
typedef struct {
    // sizeof(FramewrightFacts).
    size_t struct_size;
    // Anything is drawn that hides all behind it.
    uint32_t has_opaque;
    // Anything with holes that its alpha cuts is drawn.
    uint32_t has_alpha_clip;
    // Anything transparent is drawn.
    uint32_t has_transparent;
    // Anything fades by leaving out fragments.
    uint32_t has_cross_fade;
    // Any light casts shadows, and there is something to cast them.
    uint32_t casts_shadows;
    // How many cascades the sun's shadows need.
    uint32_t shadow_cascades;
    // How many suns shine.
    uint32_t suns;
    // How many point lights shine.
    uint32_t point_lights;
    // How many objects there are.
    uint32_t objects;
    // How many triangles all objects have.
    uint64_t triangles;
    // The most radiance that a pixel can show before any effect, linear; finite.
    double peak_radiance;
    // The farthest distance divided by the nearest one, which formats of depth follow; 0: not known.
    double depth_range;
    // A length that is typical of the scene, metres; 0: 1.
    double size;
} FramewrightFacts;

// Is told a feature that a plan uses: Vulkan's name of it, of the property where none switches it on, or of the extension where it has no
// feature; and the first that uses it, in words. Both live until it returns.
typedef void (*FramewrightFeature)(void *context, const char *name, const char *used_by);

// An image or buffer of the program's that a frame uses.
typedef struct {
    // The name of the external image or buffer.
    const char *name;
    // The number of the one to use among those that were imported, from 0.
    size_t image;
} FramewrightChoice;

// A semaphore that a frame waits for or signals.
typedef struct {
    // The semaphore.
    VkSemaphore semaphore;
    // The value of a timeline semaphore; it doesn't matter for a binary one.
    uint64_t value;
    // The stages that wait, or that are waited for; 0: all.
    VkPipelineStageFlags2 stages;
} FramewrightSemaphore;

// How a frame is submitted among the program's own work. 0 in a field is its default.
typedef struct {
    // sizeof(FramewrightSubmission).
    size_t struct_size;
    // Images and buffers of the program's, for external ones of which several were imported. An image that isn't listed is that of the
    // frame before; a buffer is the one whose turn it is.
    const FramewrightChoice *images;
    // How many.
    size_t image_count;
    // What the frame waits for before it begins.
    const FramewrightSemaphore *waits;
    // How many.
    size_t wait_count;
    // What it signals at its end.
    const FramewrightSemaphore *signals;
    // How many.
    size_t signal_count;
} FramewrightSubmission;

// Records a pass: commands that touch what the pipeline says that the pass touches, and what is the program's own. Returns 0 if it
// doesn't know the pass, which is an error of the frame. No function is called for the renderer meanwhile, and no
// exception or longjmp leaves it.
typedef uint32_t (*FramewrightRecord)(void *context, const FramewrightPass *pass);

// The state of an image or buffer: what used it last, or uses it next.
typedef struct {
    // Stages.
    VkPipelineStageFlags2 stages;
    // Accesses.
    VkAccessFlags2 accesses;
    // The layout; `VK_IMAGE_LAYOUT_UNDEFINED` for a buffer, and for an image whose contents the frame doesn't need.
    VkImageLayout layout;
} FramewrightState;

// The texels of an image: layer after layer, slice after slice, rows from the top, without padding; the machine's byte order.
typedef struct {
    // The format of a texel. Of depth and stencil one is read: the depth takes 2 bytes for `VK_FORMAT_D16_UNORM`, else 4.
    VkFormat format;
    // Width in texels.
    uint32_t width;
    // Height in texels.
    uint32_t height;
    // Depth in texels: 1, but for a volume.
    uint32_t depth;
    // Array layers.
    uint32_t layers;
    // The bytes.
    const uint8_t *bytes;
    // How many bytes there are.
    size_t byte_count;
} FramewrightTexels;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The interface of the library that the program runs with: compare it with `FRAMEWRIGHT_ABI`.
uint32_t framewright_abi(void);

// The version of the library that the program runs with, as a text such as `1.2.3`.
const char *framewright_version(void);

// What the last call of this thread that failed said, with file, line and column where a file is wrong; never NULL. It lives until
// another call of this thread fails, or the thread ends.
const char *framewright_last_error(void);

// The mistakes in files and choices that this error consists of, by their numbers from 0; NULL behind the last one, and if it is
// another error. They live as long as its text.
const FramewrightMistake *framewright_last_mistake(size_t number);

// Opens a device of the library's own. `options` may be NULL.
FramewrightStatus framewright_device_open(const FramewrightDeviceOptions *options, FramewrightDevice **device);

// The device's name, which lives as long as the handle; NULL for NULL.
const char *framewright_device_name(const FramewrightDevice *device);

// Tells Vulkan's handles of a device, for buffers, images and pipelines of the program's own. They live as long as the device, and the program
// destroys none of them. While a call of the library draws, uploads or reads back, no other thread submits to queues of the device.
FramewrightStatus framewright_device_vulkan(const FramewrightDevice *device,
                                            FramewrightVulkan *vulkan);

// Plants mistakes, and fails if the validation layer doesn't report them, or if settings in the environment keep it from reporting others.
// What it plants is no finding.
FramewrightStatus framewright_device_canary(const FramewrightDevice *device);

// Tells each finding of the validation layer so far, once however often the layer said it: none without `FramewrightDeviceOptions::validation`.
FramewrightStatus framewright_device_findings(const FramewrightDevice *device,
                                              FramewrightFinding tell,
                                              void *context);

// Tells each image of the library's that was destroyed since the last call; the first call begins to look. A program that keeps views of
// images that it was told, as by `framewright_pass_image`, destroys those views then: another image may have the same handle later.
// It asks in the function that records the pass, before it looks up a view.
FramewrightStatus framewright_device_dead_images(const FramewrightDevice *device,
                                                 FramewrightDeadImage tell,
                                                 void *context);

// Frees the handle of a device. What was made from it keeps it open.
void framewright_device_free(FramewrightDevice *device);

// Uses a device that the program made itself. The library destroys what it makes from it, and neither device nor instance: they outlive
// all that is made from the handle.
FramewrightStatus framewright_device_adopt(const FramewrightAdoptedDevice *program,
                                           FramewrightDevice **device);

// Opens a device of a program's physical device, to find out what the program makes its own device with: renderers on it tell what their
// frames use, `framewright_renderer_device_features`. It has every feature that is used, as far as the physical device has them. The
// instance has Vulkan 1.3 as its `apiVersion`, comes from the system's loader, and outlives all that is made from the handle.
// `instance_extensions` are those that it was created with; NULL: none. `helper` is as in FramewrightDeviceOptions.
FramewrightStatus framewright_device_open_physical(VkInstance instance,
                                                   const FramewrightNames *instance_extensions,
                                                   VkPhysicalDevice physical_device,
                                                   const char *helper,
                                                   FramewrightDevice **device);

// Tells with which features and extensions the program makes a device that the library is to use: those that
// `framewright_renderer_features` lists, or of several renderers all lists together. NULL: all that any renderer uses where the device has
// it. It is an error if the device lacks any, or of the latter what the library needs everywhere. `robustBufferAccess` is among the latter
// alone: add it where files or shaders of strangers are drawn. Freed by `framewright_features_free`.
FramewrightStatus framewright_features_open(VkInstance instance,
                                            VkPhysicalDevice physical_device,
                                            const FramewrightNames *used,
                                            FramewrightFeatures **features);

// The features, chained: for `VkDeviceCreateInfo.pNext` and `FramewrightAdoptedDevice.features`. It lives as long as the handle; NULL for
// NULL.
const VkPhysicalDeviceFeatures2 *framewright_features_chain(const FramewrightFeatures *features);

// The extensions of the device, for `VkDeviceCreateInfo` and `FramewrightAdoptedDevice.device_extensions`. They live as long as the handle;
// none for NULL. A program that presents adds `VK_KHR_swapchain`, if it isn't among them.
FramewrightNames framewright_features_extensions(const FramewrightFeatures *features);

// Frees the handle of features.
void framewright_features_free(FramewrightFeatures *features);

// Reads a scene from a file (`.ron`, `.gltf`, `.glb`); where there is none, the shipped scene of that name.
FramewrightStatus framewright_scene_load(const char *path, FramewrightScene **scene);

// The mistakes in the file of a scene that were passed over, by their numbers from 0, each with what was left out or changed; NULL behind
// the last one, and for NULL. They live as long as the handle.
const char *framewright_scene_mistake(const FramewrightScene *scene,
                                      size_t number);

// Frees the handle of a scene. Renderers that show it go on.
void framewright_scene_free(FramewrightScene *scene);

// Tells an image that a pass accesses, by the pipeline's name. Any thread may ask until the callback of the pass returns.
FramewrightStatus framewright_pass_image(const FramewrightPass *pass,
                                         const char *name,
                                         FramewrightPassImage *image);

// Tells a buffer that a pass accesses, by the pipeline's name. Any thread may ask until the callback of the pass returns.
FramewrightStatus framewright_pass_buffer(const FramewrightPass *pass,
                                          const char *name,
                                          VkBuffer *buffer);

// Tells the numbers of a parameter that the pipeline gives the pass: the components of a vector, the columns of a matrix one behind the other, 0 or 1
// for a truth value. `count` is how many `numbers` has room for, and is told how many there are; if there are more, it is `FRAMEWRIGHT_STATUS_MISUSE`.
// Images, buffers and parameters of a compute pass are its shader's: nothing is told of them.
FramewrightStatus framewright_pass_param(const FramewrightPass *pass,
                                         const char *name,
                                         double *numbers,
                                         size_t *count);

// Fills the set number `set` of the draw interface `brought` with `bindings`, each of its bindings once. `brought` is as one in
// `FramewrightRendererOptions.draws`; kinds of draws that bring the same share bind groups.
//
// Buffers, views and samplers are the program's, of this device, and made for what they are bound as. They live until the last frame is done
// that was drawn with the group. No Plan knows of them: the program makes their barriers.
FramewrightStatus framewright_bind_group_open(const FramewrightDevice *device,
                                              const FramewrightDrawInterface *brought,
                                              uint32_t set,
                                              const FramewrightBinding *bindings,
                                              size_t binding_count,
                                              FramewrightBindGroup **group);

// Frees a bind group. What was bound of it stays bound in the frames on their way.
void framewright_bind_group_free(FramewrightBindGroup *group);

// Binds a group for the draws of a pass from now on, or for a compute pass. One of another set, or of another draw interface, is the error of the
// frame.
FramewrightStatus framewright_pass_bind_group(const FramewrightPass *pass,
                                              uint32_t set,
                                              const FramewrightBindGroup *group);

// Binds a descriptor set of the program's for the draws of a pass from now on, or for a compute pass, in place of the one of
// `framewright_renderer_bind_set`. All else is as there. One that the pass's shader doesn't read is left out.
FramewrightStatus framewright_pass_bind_set(const FramewrightPass *pass,
                                            uint32_t set,
                                            VkDescriptorSet descriptors,
                                            const uint32_t *offsets,
                                            size_t offset_count);

// Binds `byte_count` bytes of a buffer of the program's, from `offset` on, as the vertex buffer `number` of the draw interface. `offset` is a multiple
// of 4. The buffer was made for vertices, holds that much, and lives until the last frame is done that reads it; the program makes its barriers.
FramewrightStatus framewright_pass_bind_vertex_buffer(const FramewrightPass *pass,
                                                      uint32_t number,
                                                      VkBuffer buffer,
                                                      uint64_t offset,
                                                      uint64_t byte_count);

// Binds `byte_count` bytes of a buffer of the program's, from `offset` on, as the indices: `VK_INDEX_TYPE_UINT16` or `VK_INDEX_TYPE_UINT32`, and
// `offset` is a multiple of an index's bytes. All else is as for vertices.
FramewrightStatus framewright_pass_bind_index_buffer(const FramewrightPass *pass,
                                                     VkBuffer buffer,
                                                     uint64_t offset,
                                                     uint64_t byte_count,
                                                     VkIndexType type_of_index);

// Sets push constants from byte `offset` on, for the draws of a pass from now on, as the draw interface tells them. Both numbers are multiples of 4.
// Where no stage of the pass reads any they are left out.
FramewrightStatus framewright_pass_push_constants(const FramewrightPass *pass,
                                                  uint32_t offset,
                                                  const void *constants,
                                                  size_t byte_count);

// Says which faces are left out from now on, unless the pipeline says it of the pass: at first none.
FramewrightStatus framewright_pass_set_cull_mode(const FramewrightPass *pass, VkCullModeFlags mode);

// Says which side is the front from now on, as seen in the picture: at first `VK_FRONT_FACE_COUNTER_CLOCKWISE`.
FramewrightStatus framewright_pass_set_front_face(const FramewrightPass *pass, VkFrontFace face);

// Says to which rectangle of the upright picture clip space is stretched from now on, in texels: at first to all of it. Where instances draw into both
// eyes' halves it is all of it.
FramewrightStatus framewright_pass_set_viewport(const FramewrightPass *pass,
                                                double x,
                                                double y,
                                                double width,
                                                double height);

// Says in which rectangle of the upright picture texels may change from now on: at first in all of it. What lies outside the picture is left out. Where
// instances draw into both eyes' halves it is all of it.
FramewrightStatus framewright_pass_set_scissor(const FramewrightPass *pass,
                                               uint32_t x,
                                               uint32_t y,
                                               uint32_t width,
                                               uint32_t height);

// Draws consecutive vertices of a pass inside a rendering scope whose shader is the pipeline's, for both eyes where the pass is for both.
// Shaders see `first_instance` as their first `gl_InstanceIndex`. It records into `commands` of the pass, which one thread does at a time.
//
// It draws with the pipeline of the pass, and with what the functions `framewright_pass_…` have bound. Once the program has bound anything itself in
// `commands`, or has set push constants there, none of them is called for this pass any more. A draw that lacks what its shader reads (vertex buffers, bind
// groups, push constants, a set of the program's), or that reads beyond a vertex buffer, is the error of the frame.
FramewrightStatus framewright_pass_draw(const FramewrightPass *pass,
                                        uint32_t first_vertex,
                                        uint32_t vertex_count,
                                        uint32_t first_instance,
                                        uint32_t instance_count);

// Draws indexed vertices; `base_vertex` is added to each index. Indices that aren't in the index buffer are the error of the frame. Vertices that
// indices choose aren't checked: `robustBufferAccess` keeps them within the VkBuffer; without it the program vouches for them. All else is as for
// `framewright_pass_draw`.
FramewrightStatus framewright_pass_draw_indexed(const FramewrightPass *pass,
                                                uint32_t first_index,
                                                uint32_t index_count,
                                                int32_t base_vertex,
                                                uint32_t first_instance,
                                                uint32_t instance_count);

// Reads the pipeline in the file `pipeline`; where there is none, the shipped one of that name. Until it is told otherwise, the frame
// has 1280×720 texels, and the scene may hold everything. `options` may be NULL.
FramewrightStatus framewright_renderer_open(const FramewrightDevice *device,
                                            const char *pipeline,
                                            const FramewrightRendererOptions *options,
                                            FramewrightRenderer **renderer);

// Does the same with a pipeline that the program carries within itself, the text `pipeline`, which messages call `name`. The files and shaders that
// it names are shipped ones, or of the folders in `FramewrightRendererOptions.shaders`.
FramewrightStatus framewright_renderer_open_carried(const FramewrightDevice *device,
                                                    const char *name,
                                                    const char *pipeline,
                                                    const FramewrightRendererOptions *options,
                                                    FramewrightRenderer **renderer);

// Frees a renderer. Frames on their way are waited for.
void framewright_renderer_free(FramewrightRenderer *renderer);

// Gives a setting a value, which is stronger than presets and settings files: a number, `true`, `false` or a name, as text. NULL takes
// it back. A value that isn't allowed changes nothing.
FramewrightStatus framewright_renderer_set(FramewrightRenderer *renderer,
                                           const char *setting,
                                           const char *value);

// Puts a preset in force, in place of the one before; NULL: that of the settings files, if they name one.
FramewrightStatus framewright_renderer_set_preset(FramewrightRenderer *renderer, const char *preset);

// Sets width and height of the output.
FramewrightStatus framewright_renderer_set_extent(FramewrightRenderer *renderer, uint32_t width, uint32_t height);

// Has images of these names leave the frame beside its outputs, so that they can be read.
FramewrightStatus framewright_renderer_set_dump(FramewrightRenderer *renderer, const char *const *images, size_t count);

// Shows a scene, and tells its facts. Where the options have `draws`, they have `scene_draws` too, or it is refused. NULL: no scene, and it may hold
// everything; passes that draw objects or the sky are the recorder's then, and without a recorder an error.
FramewrightStatus framewright_renderer_set_scene(FramewrightRenderer *renderer,
                                                 const FramewrightScene *scene);

// Tells the facts of a scene that the program draws itself; NULL: it may hold everything.
FramewrightStatus framewright_renderer_set_facts(FramewrightRenderer *renderer, const FramewrightFacts *facts);

// Says how the frame is drawn for two eyes: a FramewrightStereo. `FRAMEWRIGHT_STATUS_MACHINE`: the device can't.
FramewrightStatus framewright_renderer_set_stereo(FramewrightRenderer *renderer, uint32_t stereo);

// Says by how much the screen is turned that shows the picture: a FramewrightRotation. What is read back is upright.
FramewrightStatus framewright_renderer_set_rotation(FramewrightRenderer *renderer, uint32_t rotation);

// Tells the format of the images that the program shows the first output in, as those of a swapchain of its own: what the pipeline calls
// `format: Output`. `VK_FORMAT_UNDEFINED`: the format that the pipeline has without a window.
FramewrightStatus framewright_renderer_set_output_format(FramewrightRenderer *renderer,
                                                         VkFormat format);

// Tells each feature of a device that the next frame uses, for `framewright_features_open`. It begins with a plan, as a frame does.
FramewrightStatus framewright_renderer_features(FramewrightRenderer *renderer,
                                                FramewrightFeature tell,
                                                void *context);

// Tells with which features and extensions a program makes a device of the same physical device for the next frame: those that
// `framewright_renderer_features` tells, and no others. Freed by `framewright_features_free`.
FramewrightStatus framewright_renderer_device_features(FramewrightRenderer *renderer,
                                                       FramewrightFeatures **features);

// Whether a file that was read is another one by now: 1, else 0.
FramewrightStatus framewright_renderer_files_changed(FramewrightRenderer *renderer, uint32_t *changed);

// Reads the pipeline, its shaders and pictures anew, and plans. Mistakes in the files leave all as it was.
FramewrightStatus framewright_renderer_reload(FramewrightRenderer *renderer);

// Binds a descriptor set of the program's for all passes whose shaders read the set of this number, from the next frame on, with its
// dynamic offsets: `offset_count` of them, in the order of bindings. NULL in place of `descriptors` lets go of the one before. It must
// have the layout that the renderer was told, and live until the last frame is done that it was bound in. What shaders read of it must be
// there, in the state that it says: no Plan knows of it, and the program makes the barriers.
FramewrightStatus framewright_renderer_bind_set(FramewrightRenderer *renderer,
                                                uint32_t set,
                                                VkDescriptorSet descriptors,
                                                const uint32_t *offsets,
                                                size_t offset_count);

// Plans the next frame if anything changed; every frame begins with it. `change` is told the most that changed since the last call of this
// function, by whatever call, unless it is NULL.
// After an error the last good Plan stays, with the choices and the scene that it was made for.
FramewrightStatus framewright_renderer_prepare(FramewrightRenderer *renderer,
                                               FramewrightChange *change);

// Says that what passes with `run: WhenDirty("name")` write is out of date: they run in the next frame. A name that no pass of the Plan
// waits for is `FRAMEWRIGHT_STATUS_MISUSE`. Where anything changed, it is planned first.
FramewrightStatus framewright_renderer_set_dirty(FramewrightRenderer *renderer,
                                                 const char *name);

// Has all passes run in the next frame, as in the first one, also those that run once.
FramewrightStatus framewright_renderer_run_all(FramewrightRenderer *renderer);

// Gives the next frame a number, by which passes go that run every few frames. Frames are counted on from there; without this call they are
// counted from 0. Where anything changed, it is planned first.
FramewrightStatus framewright_renderer_set_frame_number(FramewrightRenderer *renderer,
                                                        uint64_t number);

// Sets the time of frames from the next one on, in seconds: `time` in parameters of passes. Without this call it is a sixtieth of the frame's
// number. Where anything changed, it is planned first.
FramewrightStatus framewright_renderer_set_time(FramewrightRenderer *renderer,
                                                double seconds);

// Draws a frame and waits until the device is done. `frame` is told its number, from 0, unless it is NULL.
FramewrightStatus framewright_renderer_frame(FramewrightRenderer *renderer, uint64_t *frame);

// Records and submits a frame, which waits for semaphores of the program's and signals others. `among` may be NULL. If as many frames as
// may be are on their way, the oldest is waited for first. Semaphores live until the frame was waited for; after an error nothing was
// waited for and nothing is signalled, unless the device is lost. `frame` is told its number, unless it is NULL.
FramewrightStatus framewright_renderer_submit(FramewrightRenderer *renderer,
                                              const FramewrightSubmission *among,
                                              uint64_t *frame);

// Waits until the device is done with a frame. A frame of an earlier Plan counts as done.
FramewrightStatus framewright_renderer_wait(FramewrightRenderer *renderer, uint64_t frame);

// Records a frame into a command buffer of the program's, which the program submits. The command buffer is primary, of the family of the
// device's queue for graphics, recording, and outside of a rendering scope. It is submitted once, to that queue, after the frames
// before and before later ones, and has the timeline semaphore `done` signalled with a value then; or it is given to `framewright_renderer_discard`. It and
// the semaphore live until the frame was waited for. Until the frame is submitted or discarded, nothing is set for the renderer, and no
// function is called that waits or plans.
//
// The commands find and leave images of the program's in the states that `framewright_renderer_states` tells, and change all state of the
// command buffer. `images` are as in FramewrightSubmission. `frame` is told the frame's number, unless it is NULL. After an error the
// command buffer must not be submitted.
FramewrightStatus framewright_renderer_record_into(FramewrightRenderer *renderer,
                                                   VkCommandBuffer commands,
                                                   const FramewrightSemaphore *done,
                                                   const FramewrightChoice *images,
                                                   size_t image_count,
                                                   uint64_t *frame);

// Takes back a frame that was recorded into a command buffer, which was not and will not be submitted.
FramewrightStatus framewright_renderer_discard(FramewrightRenderer *renderer, uint64_t frame);

// Has `record` record custom passes, the kinds of draws in `FramewrightRendererOptions.draws`, and draws of objects and sky where no scene was set, and
// gives it `context`; NULL: nobody does.
FramewrightStatus framewright_renderer_set_recorder(FramewrightRenderer *renderer,
                                                    FramewrightRecord record,
                                                    void *context);

// Says whether the draws of the custom passes that the pipeline calls `custom`, inside rendering scopes, come in secondary command buffers,
// which threads of the program record: 0, as at first, or 1. Custom passes outside of scopes execute such ones without a word.
//
// A secondary command buffer isn't recorded anew or freed until each frame was waited for that executes it. One that is executed again before
// that, as by the next of several frames in flight or by the same pass of the other eye, is begun with `SIMULTANEOUS_USE`; or there are
// several of it.
FramewrightStatus framewright_renderer_set_secondary(FramewrightRenderer *renderer,
                                                     const char *custom,
                                                     uint32_t has);

// Tells what pipelines must fit that the program binds itself in the pass of this name. It begins with a plan, as a frame does. What it
// points to lives as long as the renderer. `FRAMEWRIGHT_STATUS_MISUSE`: no rendering scope has such a pass.
FramewrightStatus framewright_renderer_formats(FramewrightRenderer *renderer,
                                               const char *pass,
                                               FramewrightFormats *formats);

// Tells what secondary command buffers of the pass of this name are begun with, before the frame: as `inheritance` of the pass. All else is as
// for `framewright_renderer_formats`.
FramewrightStatus framewright_renderer_inheritance(FramewrightRenderer *renderer,
                                                   const char *pass,
                                                   VkCommandBufferInheritanceRenderingInfo *inheritance);

// Tells how the pass of this name is recorded for both eyes at once: the FramewrightStereo, and how images hold both eyes' parts. Both are
// 0 if it isn't. It begins with a plan, as a frame does. `form` may be NULL.
FramewrightStatus framewright_renderer_both_eyes(FramewrightRenderer *renderer,
                                                 const char *pass,
                                                 uint32_t *stereo,
                                                 FramewrightEyeForm *form);

// Tells how an image is created that can be imported for the external image `name`: an output, or one that the pipeline calls
// `Imported`. It begins with a plan, as a frame does. What it points to lives as long as the device.
FramewrightStatus framewright_renderer_image_info(FramewrightRenderer *renderer,
                                                  const char *name,
                                                  VkImageCreateInfo *info);

// Tells the states in which each frame finds and leaves the external image or buffer `name`. `before` and `after` may be NULL.
FramewrightStatus framewright_renderer_states(FramewrightRenderer *renderer,
                                              const char *name,
                                              FramewrightState *before,
                                              FramewrightState *after);

// Takes images of the program's own for the external image `name`, from the next frame on: one, or several, as those of a swapchain,
// of which each frame uses the one that it is told. They are as `framewright_renderer_image_info` says, and are in the state that
// `framewright_renderer_states` says whenever a frame begins. They live as long as the renderer, or until others are imported and
// `framewright_renderer_wait` has waited for the last frame submitted before that import: nothing is waited for here. After
// `FRAMEWRIGHT_CHANGE_PLAN` they are to be imported again: a frame is `FRAMEWRIGHT_STATUS_MISUSE` until they are.
FramewrightStatus framewright_renderer_import_images(FramewrightRenderer *renderer,
                                                     const char *name,
                                                     const VkImage *images,
                                                     size_t count);

// Takes buffers of the program's own for the external buffer `name`, from the next frame on. Frames use them in turn: the frame of number
// `n` uses the one of number `n % count`, unless `FramewrightSubmission.images` chooses another one. All else is as for
// `framewright_renderer_import_images`.
FramewrightStatus framewright_renderer_import_buffers(FramewrightRenderer *renderer,
                                                      const char *name,
                                                      const VkBuffer *buffers,
                                                      size_t count);

// Says who has the external image or buffer `name` between frames, a `FramewrightOwner`, in place of what the pipeline says. Each frame then
// takes it over before its first use, in the state `before` of `framewright_renderer_states`, and gives it back in the state `after`. The owner
// gives and takes it by barriers of its own. It holds by name, for later Plans too. Frames in flight are waited for.
FramewrightStatus framewright_renderer_set_owner(FramewrightRenderer *renderer,
                                                 const char *name,
                                                 uint32_t owner);

// Tells Vulkan's image that stood for the image `name` in the last frame, for commands of the program's own.
FramewrightStatus framewright_renderer_image(FramewrightRenderer *renderer, const char *name, VkImage *image);

// Makes another renderer of the pipeline, with the choices, the scene and the names of `framewright_renderer_set_secondary` of this one. It reads the
// files anew, has drawn nothing, and has no recorder. Choices can be tried with it on another thread, and `framewright_renderer_make_pipelines` called,
// while this one draws.
FramewrightStatus framewright_renderer_clone(FramewrightRenderer *renderer,
                                             FramewrightRenderer **other);

// Makes all Vulkan pipelines that the next frame needs, on several threads. The device keeps them while there is a Plan, so that another renderer that
// comes to the same choices finds them made.
FramewrightStatus framewright_renderer_make_pipelines(FramewrightRenderer *renderer);

// Tells the text of a file with all that the program's draws bring along, its sets and its custom passes: `framewright check --interface` checks
// pipelines with it. The text lives as long as the renderer.
FramewrightStatus framewright_renderer_interface(FramewrightRenderer *renderer,
                                                 const char **ron);

// Reads the output `name`, an image, as the last frame left it. Frames on their way are waited for. The bytes live until the next call of
// this function for the renderer, or until it is freed.
FramewrightStatus framewright_renderer_read(FramewrightRenderer *renderer,
                                            const char *name,
                                            FramewrightTexels *texels);

// Serves a page of the running program at `address`, such as "127.0.0.1:7117"; with port 0 at a port that is free. The page is for those alone
// who know its whole address: `framewright_viewer_url`. An address that other machines reach shows the program's files to them.
// `FRAMEWRIGHT_STATUS_MACHINE`: the address can't be had.
FramewrightStatus framewright_viewer_serve(const char *address,
                                           FramewrightViewer **viewer);

// Shows the frame that a renderer drew last, and has it take the settings that were chosen in the page: the next frame has them. Called after
// each frame, of each renderer that is to be seen. While no page is open it costs next to nothing. A setting that is refused is told in
// the page. No frame that was recorded into the program's command buffers may wait to be submitted.
FramewrightStatus framewright_viewer_frame(FramewrightViewer *viewer,
                                           FramewrightRenderer *renderer);

// Tells the address of the page, of which a part is secret. It lives as long as the handle.
FramewrightStatus framewright_viewer_url(const FramewrightViewer *viewer, const char **url);

// Ends a page, and its server.
void framewright_viewer_free(FramewrightViewer *viewer);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* FRAMEWRIGHT_H */
