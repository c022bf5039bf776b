/// @file
/// Studies `floor` and `layers`: what a still column feels of the floor that carries it, for three kinds of
/// floor.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "10_water_sph/scene.cuh"
#include "10_water_sph/study_water.cuh"

namespace sph {

//! [Floor]
/// What carries the water.
enum class Floor {
    mirror,           ///< this chapter's wall
    fixed_particles,  ///< two layers of particles that never move and are water in all else
    springs,          ///< a push on particles nearer than half a spacing; beyond it there is nothing
};

/// A shaft eight spacings wide, with mirrors at its sides and water that has come to rest in it. Leapfrog
/// runs on the host: the water is made anew at each step, for its forces alone, so that any floor will do.
class Column {
  public:
    static constexpr float kHeight_m = 1, kWide = 8;

    Column(Floor floor, int spacings_high)
        : floor_(floor),
          spacing_m_(kHeight_m / spacings_high),
          box_{{0, 0, 0}, {width(), 2, width()}, {Wall::periodic, Wall::slip, Wall::periodic}} {
        Scene shaft{"shaft", box_, {0, 0, 0}, {width(), kHeight_m, width()}};
        float spacing_m = 0;
        position_ = fill_block(shaft, std::uint32_t(kWide * kWide) * spacings_high, 1, spacing_m);
        shake(position_, 0.5f * spacing_m_);  // no lattice is left: what order there is comes from the floor
        for (float4& x : position_) {
            glm::vec3 place = grid::xyz(x), no_velocity(0);
            keep_inside(box_, place, no_velocity);
            x = make_float4(place.x, place.y, place.z, 0);
        }
        moving_ = position_.size();
        // Ten times the speed of the fastest water a column could make; and viscous: it comes to rest soon.
        fluid_ = make_fluid(shaft, spacing_m_, {2, 10.0f / 6, 3});
        dt_s_ = time_step_limit(fluid_).smallest_s();
        if (floor != Floor::mirror) box_.low_m.y = -10 * spacing_m_;  // out of reach
        if (floor == Floor::fixed_particles)
            for (int layer = 0; layer < 2; ++layer)
                for (int k = 0; k < kWide * kWide; ++k)
                    position_.push_back(make_float4((k % int(kWide) + 0.5f) * spacing_m_,
                                                    -(layer + 0.5f) * spacing_m_,
                                                    (k / int(kWide) + 0.5f) * spacing_m_, 0));
        velocity_ = at_rest(position_.size());
        compute();
    }

    void step() {
        for (std::size_t i = 0; i < moving_; ++i) {
            glm::vec3 v = grid::xyz(velocity_[i]) + 0.5f * dt_s_ * grid::xyz(acceleration_[i]);
            glm::vec3 x = grid::xyz(position_[i]) + dt_s_ * v;
            keep_inside(box_, x, v);
            position_[i] = make_float4(x.x, x.y, x.z, 0);
            velocity_[i] = make_float4(v.x, v.y, v.z, 0);
        }
        compute();
        for (std::size_t i = 0; i < moving_; ++i) {
            const glm::vec3 v = grid::xyz(velocity_[i]) + 0.5f * dt_s_ * grid::xyz(acceleration_[i]);
            velocity_[i] = make_float4(v.x, v.y, v.z, 0);
        }
    }

    std::size_t moving() const { return moving_; }  ///< the rest of the particles is floor
    const std::vector<float4>& position() const { return position_; }
    const std::vector<float>& density() const { return density_; }
    const Fluid& fluid() const { return fluid_; }
    float spacing_m() const { return spacing_m_; }
    float dt_s() const { return dt_s_; }
    /// The same particles as a water on the device, to time its steps.
    Water water() const { return {fluid_, box_, EquationOfState::linear, position_, velocity_}; }

  private:
    float width() const { return kWide * spacing_m_; }

    void compute() {
        const Water now = water();
        density_ = by_id(now, now.densities());
        acceleration_ = by_id(now, now.accelerations());
        if (floor_ != Floor::springs) return;
        // Gives way by a twentieth of a spacing under the whole column, which weighs g H / spacing.
        const float reach_m = 0.5f * spacing_m_,
                    per_s2 = 9.81f * kHeight_m / spacing_m_ / (0.05f * spacing_m_);
        for (std::size_t i = 0; i < moving_; ++i)
            acceleration_[i].y += per_s2 * std::max(reach_m - position_[i].y, 0.0f);
    }
    //! [Floor]

    Floor floor_;
    float spacing_m_, dt_s_ = 0;
    Box box_;
    Fluid fluid_;
    std::size_t moving_ = 0;
    std::vector<float4> position_, velocity_, acceleration_;
    std::vector<float> density_;
};

//! [floor_report]
/// What a column's last fifth of `time_s` says of its floor.
struct FloorReport {
    double pressure_error = 0;  ///< rms over layers of p - rho g d, over rho g H
    double lowest = 0;          ///< place of the lowest particle that is not floor, in spacings above it
    /// Rms of (number of particles in a fifth of a spacing / its mean) - 1, for the four spacings nearest the
    /// floor, and in the middle of the column. All of it is chance in water without order.
    double layering[4] = {}, middle = 0;
    int steps = 0;
};

inline FloorReport floor_report(Floor floor, int spacings_high, double time_s) {
    constexpr int kBins = 5;  // to a spacing
    Column column(floor, spacings_high);
    FloorReport report;
    report.lowest = 1e30;
    report.steps = int(std::ceil(time_s / column.dt_s()));
    const double g = 9.81, rho0 = column.fluid().rest_density_kg_per_m3, H = Column::kHeight_m;
    std::vector<double> number(kBins * spacings_high, 0), pressure(spacings_high, 0), depth(spacings_high, 0),
        counted(spacings_high, 0);
    int looks = 0;
    for (int step = 1; step <= report.steps; ++step) {
        column.step();
        if (step < 0.8 * report.steps || step % 10 != 0) continue;
        ++looks;
        for (std::size_t i = 0; i < column.moving(); ++i) {
            const double y = column.position()[i].y / column.spacing_m();
            report.lowest = std::min(report.lowest, y);
            if (y < 0 || y >= spacings_high) continue;
            ++number[int(y * kBins)];
            ++counted[int(y)];
            depth[int(y)] += H - column.position()[i].y;
            pressure[int(y)] +=
                pressure_of<EquationOfState::linear>(column.fluid(), double(column.density()[i]));
        }
    }
    for (int layer = 0; layer < spacings_high; ++layer) {
        const double error = counted[layer] > 0  // an empty layer carries nothing
                                 ? (pressure[layer] - rho0 * g * depth[layer]) / counted[layer]
                                 : rho0 * g * (H - (layer + 0.5) * column.spacing_m());
        report.pressure_error += error * error / spacings_high;
    }
    report.pressure_error = std::sqrt(report.pressure_error) / (rho0 * g * H);
    const auto layering = [&](int from, int to) {
        const double mean = double(looks) * Column::kWide * Column::kWide / kBins;
        double sum = 0;
        for (int bin = kBins * from; bin < kBins * to; ++bin)
            sum += (number[bin] / mean - 1) * (number[bin] / mean - 1);
        return std::sqrt(sum / (kBins * (to - from)));
    };
    for (int k = 0; k < 4; ++k) report.layering[k] = layering(k, k + 1);
    report.middle = layering(spacings_high / 2 - 2, spacings_high / 2 + 2);
    return report;
}
//! [floor_report]

inline std::string name_of(Floor floor) {
    return floor == Floor::mirror            ? "mirror"
           : floor == Floor::fixed_particles ? "two layers of fixed particles"
                                             : "springs";
}

inline void study_floor(course::Study& study) {
    course::on_device(study);
    const std::vector<int> heights = study.quick ? std::vector<int>{8, 12} : std::vector<int>{10, 15, 20, 30};
    const Floor floors[] = {Floor::mirror, Floor::fixed_particles, Floor::springs};
    study.expect(int(3 * heights.size()));
    for (const int high : heights) {
        std::vector<Water> waters;
        for (const Floor floor : floors) waters.push_back(Column(floor, high).water());
        const std::vector<course::Timing> per_step = time_steps(waters, study.quick ? 3 : 9);
        for (int k = 0; k < 3; ++k) {
            const FloorReport report = floor_report(floors[k], high, study.quick ? 1 : 2);
            study.add({name_of(floors[k]), double(high), double(waters[k].size()), report.pressure_error,
                       per_step[k], double(report.steps)});
        }
    }
}

inline void study_layers(course::Study& study) {
    course::on_device(study);
    const int high = study.quick ? 10 : 20;
    study.expect(15);
    for (const Floor floor : {Floor::mirror, Floor::fixed_particles, Floor::springs}) {
        std::vector<Water> waters;
        waters.push_back(Column(floor, high).water());
        const course::Timing per_step = time_steps(waters, study.quick ? 3 : 9)[0];
        const FloorReport report = floor_report(floor, high, study.quick ? 1 : 3);
        const auto add = [&](double distance, double layering) {
            study.add({name_of(floor), distance, double(waters[0].size()), layering, per_step,
                       double(report.steps)});
        };
        for (int k = 0; k < 4; ++k) add(k + 0.5, report.layering[k]);
        add(0.5 * high, report.middle);
    }
}

}  // namespace sph
