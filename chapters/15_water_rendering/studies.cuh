/// @file
/// What a better picture of water costs.
#pragma once
#include <cmath>

#include "15_water_rendering/optics.h"
#include "15_water_rendering/water_view.cuh"
#include "common/gl_context.h"
#include "common/program.h"

namespace water {

// ------------------------------------------------------------------------------------------- formulas alone

inline course::StudyQuestion fresnel_question() {
    return {"fresnel", "What does a cheaper formula for the mirror cost in light?",
            "difference of the reflected part from Fresnel's equations in double, root mean square over the "
            "angles",
            "entries"};
}

/// Reflectances at equal steps of the cosine, mixed in between.
class FresnelTable {
  public:
    explicit FresnelTable(int entries) {
        for (int k = 0; k < entries; ++k)
            values_.push_back(float(fresnel_exact(double(k) / (entries - 1), kWaterIndex)));
    }
    float operator()(float cosine) const {
        const float place = cosine * float(values_.size() - 1);
        const std::size_t k = std::min(std::size_t(place), values_.size() - 2);
        return values_[k] + (place - float(k)) * (values_[k + 1] - values_[k]);
    }

  private:
    std::vector<float> values_;
};

//! [study_fresnel]
inline void study_fresnel(course::Study& study) {
    constexpr int kAngles = 10000;
    std::vector<float> cosine, got(kAngles);
    for (int k = 0; k < kAngles; ++k) cosine.push_back(float(std::cos((k + 0.5) / kAngles * 1.5707963)));
    const auto measure = [&](const std::string& method, double value, auto&& formula) {
        const course::Timing time = course::time_work(9, [&] {
            for (int k = 0; k < kAngles; ++k) got[k] = formula(cosine[k]);
        });
        double sum = 0;
        for (int k = 0; k < kAngles; ++k) {
            const double off = got[k] - fresnel_exact(double(cosine[k]), kWaterIndex);
            sum += off * off;
        }
        study.add({method, value, double(kAngles), std::sqrt(sum / kAngles), time.per(kAngles)});
    };
    const int most = study.quick ? 64 : 1024;
    study.expect(2 + int(std::log2(most)) - 1);
    measure("exact, float", 1, [](float c) { return fresnel_exact(c, float(kWaterIndex)); });
    measure("Schlick", 1, [](float c) { return fresnel_schlick(c, float(kWaterIndex)); });
    for (int entries = 4; entries <= most; entries *= 2) measure("table", entries, FresnelTable(entries));
}
//! [study_fresnel]

// ------------------------------------------------------------------------------------------------ pictures

/// Water at work: the wave as it meets the ball.
class StudyPictures {
  public:
    explicit StudyPictures(bool quick)
        : scene_(find_scene(all_scenes(), "wave_around_sphere")),
          run_(make_run(scene_, Model::sph, quick ? 2000 : 8192, 0, 1)),
          context_(course::make_headless_context()),
          width_px_(quick ? 128 : 320) {
        const int steps = int(0.45f / run_->dt_s);
        for (int k = 0; k < steps; ++k) run_->step();
    }

    /// Linear light of a picture, and the time it takes, from particles to film.
    std::vector<float> draw(const Look& look, int repeats, course::Timing* time = nullptr) {
        SurfaceView view(width_px_, width_px_ * 9 / 16, look, scene_.stage, run_->spacing_m);
        const auto once = [&] {
            view.draw(run_->position(), run_->size(), run_->ball(), scene_.camera());
            CUDA_CHECK(cudaDeviceSynchronize());
            glFinish();
        };
        if (time)
            *time = course::time_work(repeats, once);
        else
            once();
        return view.light();
    }
    std::uint32_t size() const { return run_->size(); }
    const std::string& renderer() const { return context_->info().renderer; }

  private:
    WaterScene scene_;
    std::unique_ptr<Run> run_;
    std::unique_ptr<course::GlContext> context_;
    int width_px_;
};

/// Root mean square over pixels and colours. Light above 1 counts as 1, as on a film: one glint of the sun
/// would else outweigh the whole picture.
inline double difference(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const double off = std::fmin(a[k], 1.0f) - std::fmin(b[k], 1.0f);
        sum += off * off;
    }
    return std::sqrt(sum / double(a.size()));
}

inline course::StudyQuestion picture_question() {
    course::StudyQuestion q{
        "picture", "What does a picture of water cost, and what does a cheaper one get wrong?",
        "difference from the finest picture of the same light, root mean square in linear light",
        "rays a pixel"};
    q.lines_are_cases = true;
    return q;
}

struct Method {
    std::string name;
    Look look;
};

/// Two cases. The sun's photons change more of a picture than all the rest: so what happens to the eye's rays
/// is compared without them.
inline std::vector<std::vector<Method>> picture_methods(bool quick) {
    Look all;
    if (quick) all.sunshine_texels = 100;
    Look schlick = all, dull = all;
    schlick.schlick = true;
    dull.caustics = false;
    Look thickness = dull, straight = dull, screen = dull;
    thickness.inside = Inside::thickness;
    straight.inside = Inside::straight;
    screen.drawing = Drawing::screen_space;
    if (quick)
        return {{{"whole light, marched", all}, {"whole light, without caustics", dull}},
                {{"eye's rays, marched", dull}, {"eye's rays, screen space", checked(screen)}}};
    return {{{"whole light, marched", all},
             {"whole light, Schlick", schlick},
             {"whole light, without caustics", dull}},
            {{"eye's rays, marched", dull},
             {"eye's rays, thickness", thickness},
             {"eye's rays, not bent", straight},
             {"eye's rays, screen space", checked(screen)}}};
}

//! [study_picture]
inline void study_picture(course::Study& study) {
    StudyPictures pictures(study.quick);
    study.backend = "opengl";
    study.device = pictures.renderer();
    const auto cases = picture_methods(study.quick);
    const std::vector<int> samples = study.quick ? std::vector<int>{1, 4} : std::vector<int>{1, 4, 16};
    study.expect(int(samples.size() * (cases[0].size() + cases[1].size())));
    for (const std::vector<Method>& methods : cases) {
        Look finest = methods.front().look;
        finest.samples = study.quick ? 9 : 64;
        finest.step_in_nodes = 0.5f;
        const std::vector<float> truth = pictures.draw(finest, 1);
        for (Method method : methods)
            for (const int s : samples) {
                method.look.samples = s;
                course::Timing time;
                const std::vector<float> light = pictures.draw(method.look, study.quick ? 1 : 2, &time);
                study.add({method.name, double(s), double(pictures.size()), difference(light, truth), time});
            }
    }
}
//! [study_picture]

inline course::StudyQuestion resolution_question() {
    return {"resolution", "How fine must the field be?",
            "difference from the picture of the finest field, root mean square in linear light",
            "nodes per spacing"};
}

inline void study_resolution(course::Study& study) {
    StudyPictures pictures(study.quick);
    study.backend = "opengl";
    study.device = pictures.renderer();
    const std::vector<float> nodes =
        study.quick ? std::vector<float>{0.75f, 1.5f} : std::vector<float>{0.75f, 1, 1.5f, 2, 3};
    study.expect(int(2 * nodes.size()));
    // The smoothing stays as wide in metres: its width grows with the root of the rounds.
    const auto with_nodes = [](Look look, float nodes_per_spacing) {
        look.nodes_per_spacing = nodes_per_spacing;
        look.smoothing_rounds =
            int(std::lround(Look().smoothing_rounds * std::pow(nodes_per_spacing / 2, 2)));
        return look;
    };
    for (const bool marched : {true, false}) {
        Look look = picture_methods(study.quick).front().front().look;
        look.samples = study.quick ? 1 : 4;
        if (!marched) look.inside = Inside::thickness;
        const std::vector<float> truth = pictures.draw(with_nodes(look, study.quick ? 3 : 5), 1);
        for (const float n : nodes) {
            course::Timing time;
            const std::vector<float> light = pictures.draw(with_nodes(look, n), study.quick ? 1 : 2, &time);
            study.add({marched ? "mesh, marched" : "mesh, thickness", n, double(pictures.size()),
                       difference(light, truth), time});
        }
    }
}

inline void declare_studies(course::Program& program) {
    program.study(fresnel_question(), study_fresnel);
    program.study(picture_question(), study_picture);
    program.study(resolution_question(), study_resolution);
}

}  // namespace water
