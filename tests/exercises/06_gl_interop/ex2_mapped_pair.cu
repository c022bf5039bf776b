#include "ex2_mapped_pair.cuh"

#include <memory>
#include <numeric>

#include "common/gl_context.h"
#include "common/gl_objects.h"
#include "tests/support/course_test.h"

namespace {

constexpr int kCount = 300;  // no multiple of the block

/// An OpenGL buffer of kCount float4, all zero, registered with CUDA.
struct Registered {
    course::GlBuffer buffer{kCount * sizeof(float4)};
    cudaGraphicsResource* resource = nullptr;

    Registered() {
        const std::vector<float4> zeros(kCount, make_float4(0, 0, 0, 0));
        glBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(buffer.bytes()), zeros.data());
        const cudaError_t error =
            cudaGraphicsGLRegisterBuffer(&resource, buffer.id(), cudaGraphicsRegisterFlagsNone);
        if (error != cudaSuccess) course::skip("CUDA can't use this machine's OpenGL buffers");
    }
    Registered(const Registered&) = delete;
    Registered& operator=(const Registered&) = delete;
    ~Registered() {
        if (cuda_has_it()) cudaGraphicsUnmapResources(1, &resource);
        cudaGraphicsUnregisterResource(resource);
    }
    bool cuda_has_it() const {
        void* data = nullptr;
        std::size_t bytes = 0;
        const bool has = cudaGraphicsResourceGetMappedPointer(&data, &bytes, resource) == cudaSuccess;
        cudaGetLastError();  // the answer "no" comes as an error
        return has;
    }
    std::vector<float> x_values() const {
        std::vector<float4> all(kCount);
        glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
        glGetBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(buffer.bytes()), all.data());
        std::vector<float> x;
        for (const float4& value : all) x.push_back(value.x);
        return x;
    }
};

/// A context first, so that it goes last.
struct Pair {
    std::unique_ptr<course::GlContext> context;
    std::unique_ptr<Registered> positions, velocities;
    Pair() {
        try {
            context = course::make_headless_context();
        } catch (const course::NoOpenGl& reason) {
            course::skip(reason.what());
        }
        positions = std::make_unique<Registered>();
        velocities = std::make_unique<Registered>();
    }
};

__global__ void add_kernel(float4* positions, float4* velocities) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= kCount) return;
    positions[i].x += i;
    velocities[i].x -= i;
}

void add_once(Pair& pair) {
    interop::MappedPair mapped(pair.positions->resource, pair.velocities->resource);
    REQUIRE_MESSAGE(mapped.positions() != nullptr, "positions() has no address");
    REQUIRE_MESSAGE(mapped.velocities() != nullptr, "velocities() has no address");
    add_kernel<<<3, 128>>>(mapped.positions(), mapped.velocities());
    CUDA_CHECK(cudaGetLastError());
}

}  // namespace

TEST_CASE("what a kernel writes arrives in the right buffer") {
    course::set_hint(2);
    Pair pair;
    add_once(pair);
    std::vector<float> up(kCount), down(kCount);
    std::iota(up.begin(), up.end(), 0.0f);
    for (int i = 0; i < kCount; ++i) down[i] = -up[i];
    REQUIRE_FALSE(pair.positions->cuda_has_it());  // else there is nothing to read
    REQUIRE_FALSE(pair.velocities->cuda_has_it());
    course::check_equal(pair.positions->x_values(), up, "position", "element");
    course::check_equal(pair.velocities->x_values(), down, "velocity", "element");
}

TEST_CASE("after the scope OpenGL has both buffers") {
    course::set_hint(3);
    Pair pair;
    add_once(pair);
    CHECK_MESSAGE(!pair.positions->cuda_has_it(), "CUDA still has the positions");
    CHECK_MESSAGE(!pair.velocities->cuda_has_it(), "CUDA still has the velocities");
}

TEST_CASE("it works again and again, and contents are kept") {
    course::set_hint(3);
    Pair pair;
    for (int k = 0; k < 3; ++k) {
        add_once(pair);
        REQUIRE_FALSE(pair.positions->cuda_has_it());
        REQUIRE_FALSE(pair.velocities->cuda_has_it());
    }
    CHECK(pair.positions->x_values()[299] == 897);
    CHECK(pair.velocities->x_values()[299] == -897);
}

TEST_CASE("an exception between map and unmap leaves nothing mapped") {
    course::set_hint(3);
    Pair pair;
    bool mapped_inside = false;
    try {
        interop::MappedPair mapped(pair.positions->resource, pair.velocities->resource);
        mapped_inside = pair.positions->cuda_has_it() && pair.velocities->cuda_has_it();
        throw 1;
    } catch (int) {
    }
    CHECK_MESSAGE(mapped_inside, "the two buffers were not mapped");
    CHECK_FALSE(pair.positions->cuda_has_it());
    CHECK_FALSE(pair.velocities->cuda_has_it());
}
