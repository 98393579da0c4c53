/* Shaders that a program in C brings along compiled: in a folder, in memory, and as modules of SPIR-V by name. Has a folder to write in. */

#define _POSIX_C_SOURCE 200809L

#include "testing.h"
#include <dirent.h>

enum { MOST = 16, LARGEST = 1 << 16 };

static const char PIPELINE[] =
    "Pipeline(version: 1,\n"
    "    images: [(name: \"screen\", format: R8G8B8A8_UNORM, size: Output)],\n"
    "    passes: [(name: \"tint\", draw: FullScreen(\"tint\"), color: [\"screen\"])],\n"
    "    outputs: [\"screen\"])\n";
/* The same with a module that no folder has. */
static const char WITH_MODULE[] =
    "Pipeline(version: 1,\n"
    "    images: [(name: \"screen\", format: R8G8B8A8_UNORM, size: Output)],\n"
    "    passes: [(name: \"tint\", draw: FullScreen(\"post/tint.spv\"), color: [\"screen\"])],\n"
    "    outputs: [\"screen\"])\n";
/* Red is 1/3: no other number of the module is. */
static const char SHADER[] =
    "#version 460\n"
    "layout(location = 0) out vec4 color;\n"
    "void main() { color = vec4(1.0 / 3.0, 1.0, 0.0, 1.0); }\n";

/* The files of a folder in memory. */
typedef struct {
    FramewrightFile files[MOST];
    char names[MOST][256];
    uint32_t words[MOST][LARGEST / 4];
    size_t count;
} Files;

static void read_folder(const char *path, Files *files) {
    DIR *folder = opendir(path);
    HOLDS(folder != NULL);
    files->count = 0;
    for (struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        if (entry->d_name[0] == '.') {
            continue;
        }
        size_t number = files->count++;
        HOLDS(number < MOST);
        char whole[512];
        snprintf(whole, sizeof whole, "%s/%s", path, entry->d_name);
        snprintf(files->names[number], sizeof *files->names, "%s", entry->d_name);
        FILE *file = fopen(whole, "rb");
        HOLDS(file != NULL);
        size_t bytes = fread(files->words[number], 1, LARGEST, file);
        fclose(file);
        files->files[number] = (FramewrightFile){files->names[number], files->words[number], bytes};
    }
    closedir(folder);
}

/* The file of the shader. */
static FramewrightFile *of_shader(Files *files) {
    for (size_t number = 0; number < files->count; ++number) {
        if (strncmp(files->names[number], "tint.frag.", 10) == 0) {
            return &files->files[number];
        }
    }
    HOLDS(!"a file of the shader");
    return NULL;
}

/* Makes a third of the module two thirds. */
static void brighten(const FramewrightFile *file) {
    const float from = 1.0f / 3.0f, to = 2.0f / 3.0f;
    int changed = 0;
    for (uint32_t *word = (uint32_t *)file->bytes; word < (uint32_t *)file->bytes + file->byte_count / 4; ++word) {
        if (memcmp(word, &from, 4) == 0) {
            memcpy(word, &to, 4);
            ++changed;
        }
    }
    HOLDS(changed == 1);
}

/* The red of a frame. */
static int red(FramewrightRenderer *renderer) {
    FramewrightTexels texels;
    check(framewright_renderer_set_extent(renderer, 4, 4));
    check(framewright_renderer_frame(renderer, NULL));
    check(framewright_renderer_read(renderer, "screen", &texels));
    int found = texels.bytes[0];
    framewright_renderer_free(renderer);
    return found;
}

static int drawn(const FramewrightDevice *device, const char *pipeline, const FramewrightRendererOptions *options) {
    FramewrightRenderer *renderer;
    check(framewright_renderer_open_carried(device, "mine.ron", pipeline, options, &renderer));
    return red(renderer);
}

static void count(void *findings, const char *text) {
    fprintf(stderr, "%s\n", text);
    ++*(size_t *)findings;
}

int main(void) {
    static Files files;
    write_file("tint.frag", SHADER);
    FramewrightDeviceOptions device_options = {.struct_size = sizeof device_options, .validation = 1};
    FramewrightDevice *device;
    check(framewright_device_open(&device_options, &device));
    check(framewright_device_canary(device));
    FramewrightVulkan vulkan;
    check(framewright_device_vulkan(device, &vulkan));
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(vulkan.physical_device, &properties);
    HOLDS(strcmp(properties.deviceName, framewright_device_name(device)) == 0 && vulkan.instance != NULL && vulkan.device != NULL);

    /* A folder that is filled. */
    const char *folder = ".";
    FramewrightRendererOptions options = {.struct_size = sizeof options, .shaders = {&folder, 1}, .precompiled = "compiled"};
    HOLDS(drawn(device, PIPELINE, &options) == 85 && opendir("compiled") == NULL);
    options.precompiled_adds = 1;
    HOLDS(drawn(device, PIPELINE, &options) == 85);
    read_folder("compiled", &files);

    /* Its files in memory are those that are drawn, and not the text, which is compiled where there is none. */
    brighten(of_shader(&files));
    options.precompiled = NULL;
    options.precompiled_adds = 0;
    options.precompiled_files = files.files;
    options.precompiled_file_count = files.count;
    HOLDS(drawn(device, PIPELINE, &options) == 170);
    options.precompiled_file_count = 0;
    HOLDS(drawn(device, PIPELINE, &options) == 85);
    options.precompiled = "compiled";
    options.precompiled_file_count = files.count;
    FramewrightRenderer *none;
    FAILS(framewright_renderer_open(device, "forward", &options, &none), MISUSE, "`precompiled` names a folder");
    options.precompiled = NULL;
    options.precompiled_adds = 1;
    FAILS(framewright_renderer_open(device, "forward", &options, &none), MISUSE, "`precompiled_adds` takes a folder");
    options.precompiled_adds = 0;

    /* What is no SPIR-V is an error of the frame. */
    FramewrightFile file = *of_shader(&files);
    const FramewrightFile odd[] = {{file.name, "", 0}, {file.name, file.bytes, file.byte_count - 1}, {file.name, PIPELINE, 64}};
    options.precompiled_file_count = 1;
    for (size_t number = 0; number < 3; ++number) {
        options.precompiled_files = &odd[number];
        check(framewright_renderer_open_carried(device, "mine.ron", PIPELINE, &options, &none));
        FAILS(framewright_renderer_frame(none, NULL), MISTAKES, "in memory is no SPIR-V");
        framewright_renderer_free(none);
    }
    options.precompiled_file_count = 0;

    /* A module by the name of a file that there is none of. */
    const FramewrightFile modules[] = {{"other.spv", PIPELINE, 64}, {"post/tint.spv", file.bytes, file.byte_count}};
    options.spirv = modules;
    options.spirv_count = 2;
    HOLDS(drawn(device, WITH_MODULE, &options) == 170);
    options.spirv_count = 1;
    check(framewright_renderer_open_carried(device, "mine.ron", WITH_MODULE, &options, &none));
    FAILS(framewright_renderer_frame(none, NULL), MISTAKES, "post/tint.spv");
    framewright_renderer_free(none);

    /* Wrong files. */
    const FramewrightFile wrong[] = {
        {NULL, file.bytes, 4}, {"\xff", file.bytes, 4}, {"a", NULL, 4}, {"a", file.bytes, (16u << 20) + 1}, {"a", file.bytes, SIZE_MAX}};
    const char *said[] = {"[0].name` is NULL", "[0].name` is no UTF-8", "[0].bytes` is NULL", "16777217 bytes", " bytes, and at most"};
    for (size_t number = 0; number < sizeof wrong / sizeof *wrong; ++number) {
        options.spirv = &wrong[number];
        options.spirv_count = 1;
        FAILS(framewright_renderer_open(device, "forward", &options, &none), MISUSE, said[number]);
        options.spirv_count = 0;
        options.precompiled_files = &wrong[number];
        options.precompiled_file_count = 1;
        FAILS(framewright_renderer_open(device, "forward", &options, &none), MISUSE, said[number]);
        options.precompiled_file_count = 0;
    }
    options.spirv_count = SIZE_MAX;
    FAILS(framewright_renderer_open(device, "forward", &options, &none), MISUSE, "`spirv` has ");
    options.spirv = NULL;
    FAILS(framewright_renderer_open(device, "forward", &options, &none), MISUSE, "`spirv` is NULL");
    options.spirv_count = 0;
    options.precompiled_file_count = 1u << 20;
    FAILS(framewright_renderer_open(device, "forward", &options, &none), MISUSE, "`precompiled_files` has ");
    FAILS(framewright_renderer_open_carried(device, NULL, PIPELINE, NULL, &none), MISUSE, "`name` is NULL");
    FAILS(framewright_renderer_open_carried(device, "mine.ron", NULL, NULL, &none), MISUSE, "`pipeline` is NULL");
    FAILS(framewright_renderer_open_carried(device, "mine.ron", "Pipeline(\n    vers: 1)", NULL, &none), MISTAKES, "mine.ron:2:5");
    HOLDS(none == NULL);

    size_t findings = 0;
    check(framewright_device_findings(device, count, &findings));
    framewright_device_free(device);
    return findings == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
