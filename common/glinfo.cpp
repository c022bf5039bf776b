// One line about the OpenGL of this machine; exit code 1 and the reason if there is none.
#include <cstdio>

#include "common/gl_context.h"

int main() {
    try {
        const auto context = course::make_headless_context();
        const course::GlInfo& info = context->info();
        std::printf("OpenGL %s, %s, %s\n", info.version.c_str(), info.renderer.c_str(),
                    info.platform.c_str());
        return 0;
    } catch (const course::NoOpenGl& reason) {
        std::fprintf(stderr, "%s\n", reason.what());
        return 1;
    }
}
