/// @file
/// From particles to the light on the film: all steps of one picture in their order, in memory made once.
#pragma once
#include <optional>

#include "13_volume_rendering/film.cuh"
#include "13_volume_rendering/fire_light.cuh"
#include "13_volume_rendering/splat.cuh"
#include "13_volume_rendering/stage.cuh"

namespace volume {

/// Everything a picture of a volume depends on, besides particles and camera.
struct VolumeLook {
    glm::vec3 low_m{-0.5f, 0, -0.5f}, high_m{0.5f, 1, 0.5f};  ///< the grid's box
    float cell_m = 0.0125f;
    float step_in_cells = 0.5f;
    float enough = 0.005f;  ///< a ray ends when less than this shows of what lies behind
    int block_edge = 8;     ///< 0: no empty space is skipped
    int light_edge = 4;     ///< a cell of the light grid is so many cells long; 0: smoke is black
    bool shadows = true;    ///< does smoke dim the light on other smoke?
    int glows = 4;          ///< parts of the fire that smoke, logs and ground see
    float albedo = 0.25f;   ///< of soot
    Gas gas;
    Cargos cargos;
    Detail detail;      ///< its table is made by FireVolume
    int samples = 2;    ///< rays of a pixel
    bool solid = true;  ///< are there logs and a ground?
    SolidStage stage;
    Film film;
};

/// Is there more to a picture than one ray of the volume for each pixel?
inline bool composites(const VolumeLook& look) {
    return look.solid || look.samples > 1;
}

//! [composite]
/// One thread per pixel: the volume's light, and what it lets through of what lies behind (nullptr: nothing
/// does). A pixel is the mean of its samples; the first one starts it.
inline __global__ void composite_kernel(float4* light, const float4* seen, const float4* behind, int pixels,
                                        int sample, int samples) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= pixels) return;
    const float4 s = seen[i], none = make_float4(0, 0, 0, 0);
    const float4 b = behind ? behind[i] : none, before = sample > 0 ? light[i] : none;
    const float part = 1 / float(samples);
    light[i] = make_float4(before.x + part * (s.x + s.w * b.x), before.y + part * (s.y + s.w * b.y),
                           before.z + part * (s.z + s.w * b.z), before.w + part * s.w);
}
//! [composite]

/// @throws course::BadInput naming the first number that makes no sense
inline void check(const VolumeLook& look) {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    want(look.step_in_cells > 0 && look.step_in_cells <= 1000,
         "a step must be above 0 and at most 1000 cells long");
    want(look.light_edge >= 0 && look.light_edge <= 64, "a cell of the light grid is 0 to 64 cells long");
    want(look.block_edge >= 0 && look.block_edge <= 64, "blocks are 0 to 64 cells long");
    want(look.samples >= 1 && look.samples <= 64, "a pixel has 1 to 64 samples");
    want(look.glows >= 1 && look.glows <= kMaxGlows, "the fire is cut into 1 to 6 parts");
    want(look.albedo >= 0 && look.albedo <= 1, "the albedo must be from 0 to 1");
    want(look.gas.extinction_m2_per_kg >= 0 && std::isfinite(look.gas.extinction_m2_per_kg),
         "the extinction of soot must be 0 or more");
    want(look.gas.flame_K > look.gas.air_K, "a flame must be hotter than the air");
}

//! [FireVolume]
/// A fire's volume on the device. fill() takes the particles, draw() makes a picture of what they left.
class FireVolume {
  public:
    /// @throws course::BadInput if the look makes no sense, or the device has not the memory
    explicit FireVolume(const VolumeLook& look)
        : look_((check(look), look)),
          splatter_(grid_over(look.low_m, look.high_m, look.cell_m), look.gas),
          glow_(glow_table()) {
        const grid::CellGrid& cells = splatter_.cells();
        if (look.block_edge > 0)
            blocks_.emplace(cells, look.block_edge,
                            1 + int(std::ceil(look.detail.reach_m * cells.cells_per_m)));
        if (look.detail.reach_m > 0) detail_ = course::DeviceBuffer<float4>(detail_table(kDetailSeed));
        power_size_ = block_counts(cells, kPowerEdge);
        power_ = course::DeviceBuffer<float4>(std::size_t(power_size_.x) * power_size_.y * power_size_.z);
        if (look.light_edge > 0) {
            coarse_ = {cells.origin_m, cells.cells_per_m / float(look.light_edge),
                       block_counts(cells, look.light_edge)};
            fluence_ = course::DeviceBuffer<float4>(coarse_.cell_count());
        }
    }

    /// Particles to extinction and temperature; then the light that these give to each other.
    void fill(const float4* position, const float4* velocity, std::uint32_t n) {
        splatter_.splat(position, velocity, n, look_.cargos);
        if (blocks_) blocks_->build(splatter_.field());
        const FireField<false> dark = dark_field();
        const std::uint32_t count = std::uint32_t(power_.size());
        power_kernel<<<grid::blocks_for(count, 64), 64>>>(power_.data(), dark, kPowerEdge, power_size_);
        CUDA_CHECK(cudaGetLastError());
        glows_ = make_glows(power_.download(), splatter_.cells(), kPowerEdge, power_size_, look_.glows);
        if (look_.light_edge == 0) return;
        fluence_kernel<<<grid::blocks_for(coarse_.cell_count(), 64), 64>>>(
            fluence_.data(), coarse_, dark, glows_, 4 * 3.14159265f * look_.stage.sky_high,
            0.5f / coarse_.cells_per_m, look_.shadows);
        CUDA_CHECK(cudaGetLastError());
    }

    /// @param[out] seen light RGB and transmittance, one per pixel; @param solid_m where rays end, or nullptr
    void draw(float4* seen, const Lens& lens, const float* solid_m = nullptr) const {
        const MarchSettings settings{look_.step_in_cells * look_.cell_m, look_.enough};
        const bool skip = blocks_.has_value(), detail = look_.detail.reach_m > 0;
        if (skip && detail) return launch_march(seen, field<true, true>(), lens, settings, solid_m);
        if (skip) return launch_march(seen, field<true, false>(), lens, settings, solid_m);
        if (detail) return launch_march(seen, field<false, true>(), lens, settings, solid_m);
        launch_march(seen, field<false, false>(), lens, settings, solid_m);
    }

    /// The field that draw() marches through.
    template <bool kSkip, bool kDetail = false>
    FireField<kSkip, kDetail> field() const {
        FireField<kSkip, kDetail> f{
            splatter_.cells(), splatter_.field(), glow_.data(), look_.albedo, {}, {}, {}};
        if (look_.light_edge > 0) f.light = {coarse_, fluence_.data()};
        if constexpr (kSkip) f.blocks = blocks_->view();
        if constexpr (kDetail) {
            f.detail = look_.detail;
            f.detail.table = detail_.data();
        }
        return f;
    }

    VolumeLook& look() { return look_; }  ///< step, enough, albedo and film may change between pictures
    const VolumeLook& look() const { return look_; }
    const Splatter& splatter() const { return splatter_; }
    const Glows& glows() const { return glows_; }
    /// Device memory, all of it.
    std::size_t bytes() const {
        return splatter_.cells().cell_count() * Splatter::kBytesPerCell + glow_.bytes() + power_.bytes() +
               fluence_.bytes() + detail_.bytes() + (blocks_ ? blocks_->largest().bytes() : 0);
    }

  private:
    static constexpr int kPowerEdge = 8;
    static constexpr std::uint64_t kDetailSeed = 13;
    FireField<false> dark_field() const {
        return {splatter_.cells(), splatter_.field(), glow_.data(), look_.albedo, {}, {}, {}};
    }

    VolumeLook look_;
    Splatter splatter_;
    course::DeviceBuffer<float4> glow_, power_, fluence_, detail_;
    std::optional<BlockMap> blocks_;
    glm::ivec3 power_size_{0};
    grid::CellGrid coarse_;
    Glows glows_;
};
//! [FireVolume]

//! [sample_shift]
/// Where in a pixel its sample number `sample` lies, from the middle: each has a column of its own, and a row
/// of its own, which is the bits of its number read backwards.
inline glm::vec2 sample_shift(int sample, int samples) {
    float row = 0, half = 0.5f;
    for (int bits = sample; bits > 0; bits /= 2, half /= 2) row += float(bits % 2) * half;
    const float middle = 0.5f / float(samples) - 0.5f;
    return {float(sample) / float(samples) + middle, row + middle};
}
//! [sample_shift]

//! [Photographer]
/// Pictures of a volume and of what is solid around it.
class Photographer {
  public:
    /// @throws course::BadInput if the device has not the memory
    Photographer(int width, int height, const VolumeLook& look)
        : width_(width),
          height_(height),
          seen_(std::size_t(width) * height),
          darkroom_(width, height, look.film.glare > 0) {
        if (composites(look)) light_ = course::DeviceBuffer<float4>(seen_.size());
        if (!look.solid) return;  // nothing behind the fire: two arrays less
        behind_ = course::DeviceBuffer<float4>(seen_.size());
        solid_m_ = course::DeviceBuffer<float>(seen_.size());
    }

    course::Image photograph(const FireVolume& fire, const course::Camera& camera) {
        Lens lens = make_lens(camera, width_, height_);
        if (light_.size() == 0) {
            fire.draw(seen_.data(), lens);
            return darkroom_.develop(seen_.data(), fire.look().film);
        }
        const int samples = fire.look().samples;
        for (int sample = 0; sample < samples; ++sample) {
            const glm::vec2 shift = sample_shift(sample, samples);
            lens.shift_x = shift.x;
            lens.shift_y = shift.y;
            add_sample(fire, lens, sample, samples);
        }
        return darkroom_.develop(light_.data(), fire.look().film);
    }

  private:
    void add_sample(const FireVolume& fire, const Lens& lens, int sample, int samples) {
        const bool solid = behind_.size() > 0;
        if (solid) {
            const dim3 blocks((width_ + kTile - 1) / kTile, (height_ + kTile - 1) / kTile);
            stage_kernel<<<blocks, dim3(kTile, kTile)>>>(behind_.data(), solid_m_.data(), fire.look().stage,
                                                         fire.field<false>(), fire.glows(), lens);
            CUDA_CHECK(cudaGetLastError());
        }
        fire.draw(seen_.data(), lens, solid ? solid_m_.data() : nullptr);
        const int pixels = width_ * height_;
        composite_kernel<<<(pixels + 127) / 128, 128>>>(
            light_.data(), seen_.data(), solid ? behind_.data() : nullptr, pixels, sample, samples);
        CUDA_CHECK(cudaGetLastError());
    }

    int width_, height_;
    course::DeviceBuffer<float4> seen_, light_, behind_;
    course::DeviceBuffer<float> solid_m_;
    Darkroom darkroom_;
};
//! [Photographer]

}  // namespace volume
