/* A helper process that dies between two shaders, in a program that doesn't ignore SIGPIPE. Takes the helper, and has a folder to write in. */

#define _POSIX_C_SOURCE 200809L

#include "testing.h"
#include <signal.h>
#include <time.h>
#include <unistd.h>

static void write_shader(const char *value) {
    char text[256];
    snprintf(text, sizeof text, "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(%s); }\n", value);
    write_file("mine.frag", text);
}

int main(int count, char **arguments) {
    (void)count;
    signal(SIGPIPE, SIG_DFL);
    write_file("mine.ron", "Pipeline(version: 1, images: [(name: \"o\", format: R8G8B8A8_UNORM, size: Output)],\n"
                           "passes: [(name: \"p\", draw: FullScreen(\"mine\"), color: [\"o\"])], outputs: [\"o\"])\n");
    write_shader("0.25");
    FramewrightDeviceOptions options = {.struct_size = sizeof options, .helper = arguments[1]};
    FramewrightDevice *device;
    FramewrightRenderer *renderer;
    check(framewright_device_open(&options, &device));
    FramewrightStatus opened = framewright_renderer_open(device, "mine.ron", NULL, &renderer);
    check(opened);
    check(framewright_renderer_set_extent(renderer, 16, 16));
    FramewrightStatus drawn = framewright_renderer_frame(renderer, NULL);
    if (strcmp(arguments[2], "useless") == 0) {
        printf("%d %s\n", drawn, framewright_last_error());
        return drawn == FRAMEWRIGHT_STATUS_MACHINE ? 0 : 1;
    }
    check(drawn);
    char kill_helper[64];
    snprintf(kill_helper, sizeof kill_helper, "pgrep -P %d | xargs -r kill -9", (int)getpid());
    /* The shell is a child too, and dies with it. */
    int killed = system(kill_helper);
    (void)killed;
    nanosleep(&(struct timespec){.tv_nsec = 300000000}, NULL);
    write_shader("0.75");
    check(framewright_renderer_reload(renderer));
    check(framewright_renderer_frame(renderer, NULL));
    FramewrightTexels texels;
    check(framewright_renderer_read(renderer, "o", &texels));
    printf("%d\n", texels.bytes[0]);
    framewright_renderer_free(renderer);
    framewright_device_free(device);
    return 0;
}
