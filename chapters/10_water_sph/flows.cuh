/// @file
/// Flows whose exact course is known, in boxes with periodic ends: a standing sound wave, the Taylor-Green
/// vortices, and Poiseuille's flow between two plates. The water in them is the chapter's own.
#pragma once
#include <cmath>
#include <glm/vec2.hpp>
#include <vector>

#include "10_water_sph/diagnostics.cuh"
#include "10_water_sph/study_water.cuh"

namespace sph {

//! [sound_speed]
/// Speed of sound of a given wavelength over c, measured: the period of a small standing wave along a lattice
/// without end, from the zeros of its velocity.
/// @param steps  out: of the run
inline double sound_speed(float support_in_spacings, int wavelength_in_spacings, int& steps) {
    const int across = int(std::ceil(support_in_spacings));  // the thinnest sheet that a support allows
    LatticeBox lattice = lattice_box(wavelength_in_spacings, across, across);
    for (Wall& wall : lattice.box.wall) wall = Wall::periodic;
    const Fluid fluid = lattice_fluid(support_in_spacings);
    const double k = 2 * kPi / lattice.box.high_m.x, c = fluid.sound_speed_m_per_s;
    // Particles move by a hundredth of a spacing: far more than fp32 rounds their places by, and little
    // enough that the wave is a sine.
    const double amplitude_m_per_s = 0.01 * kLatticeSpacing * c * k;
    std::vector<float> shape;  // by particle number
    std::vector<float4> velocity;
    for (const float4& x : lattice.position) {
        shape.push_back(float(std::sin(k * x.x)));
        velocity.push_back(make_float4(float(amplitude_m_per_s) * shape.back(), 0, 0, 0));
    }
    Water water(fluid, lattice.box, EquationOfState::linear, lattice.position, velocity);
    const auto projection = [&] {
        const std::vector<float4> v = by_id(water, water.velocities());
        double sum = 0;
        for (std::size_t i = 0; i < v.size(); ++i) sum += double(v[i].x) * shape[i];
        return sum;
    };
    // cos(omega t) is zero after a quarter and after three quarters of a period.
    const float dt_s = 0.1f * fluid.support_m / fluid.sound_speed_m_per_s;
    double before = projection(), zeros[2];
    steps = 0;
    for (int found = 0; found < 2;) {
        water.step(dt_s);
        ++steps;
        const double now = projection();
        if ((now > 0) != (before > 0)) zeros[found++] = (steps - now / (now - before)) * double(dt_s);
        before = now;
    }
    // Leapfrog turns omega into (2 / dt) asin(omega dt / 2), exactly: that much is not the lattice's doing.
    const double omega = 2 / dt_s * std::sin(kPi / (zeros[1] - zeros[0]) * dt_s / 2);
    return omega / (c * k);
}
//! [sound_speed]

/// A sheet of water, periodic along x and z, two spacings thick: flows in it depend on x and y alone.
inline LatticeBox sheet(int nx, int ny, float spacing_m, Wall along_y) {
    LatticeBox sheet = lattice_box(nx, ny, 2, spacing_m);
    sheet.box.wall[0] = sheet.box.wall[2] = Wall::periodic;
    sheet.box.wall[1] = along_y;
    return sheet;
}

/// Water for it, without weight. Pulled water holds together here.
inline Fluid sheet_fluid(float spacing_m, double sound_speed_m_per_s, double viscosity_m2_per_s) {
    Fluid fluid;
    fluid.support_m = 2 * spacing_m;
    fluid.mass_kg =
        float(double(fluid.rest_density_kg_per_m3) * spacing_m * spacing_m * spacing_m / lattice_density(2));
    fluid.sound_speed_m_per_s = float(sound_speed_m_per_s);
    fluid.viscosity_m2_per_s = float(viscosity_m2_per_s);
    fluid.gravity_m_per_s2 = {0, 0, 0};
    fluid.lowest_pressure_Pa = -1e30f;
    return fluid;
}

//! [taylor_green]
/// Vortices side by side, u = sin(kx) cos(ky), v = -cos(kx) sin(ky), in a periodic square of 1 m with a
/// highest speed of 1 m/s. Friction alone slows them down: speeds fall as exp(-2 nu k^2 t), exactly.
struct TaylorGreen {
    static constexpr double kWavenumber = 2 * kPi;  // 1/m

    Water water;
    int steps = 0;

    /// Water that has been shaken and has settled, so that nothing remembers a lattice, is set in motion.
    TaylorGreen(int per_edge, double reynolds) : water(settled(per_edge, reynolds)) {}

    float dt_s() const { return time_step_limit(water.fluid()).smallest_s(); }
    double time_s() const { return steps * double(dt_s()); }
    void run_until(double time) {
        for (; time_s() < time - 0.5 * dt_s(); ++steps) water.step(dt_s());
    }
    static glm::dvec2 shape(float4 x) {
        const double kx = kWavenumber * x.x, ky = kWavenumber * x.y;
        return {std::sin(kx) * std::cos(ky), -std::cos(kx) * std::sin(ky)};
    }
    /// Largest speed, as the best fit of the vortices' shape to all particles.
    double amplitude() const {
        const auto x = water.positions().download(), v = water.velocities().download();
        double projection = 0, norm = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const glm::dvec2 u = shape(x[i]);
            projection += u.x * v[i].x + u.y * v[i].y;
            norm += u.x * u.x + u.y * u.y;
        }
        return projection / norm;
    }
    /// The viscosity that slows them down so far, over the fluid's.
    double viscosity_ratio() const {
        return -std::log(amplitude()) /
               (2 * water.fluid().viscosity_m2_per_s * kWavenumber * kWavenumber * time_s());
    }

  private:
    static Water settled(int per_edge, double reynolds) {
        const float spacing_m = 1.0f / per_edge;
        LatticeBox still = sheet(per_edge, per_edge, spacing_m, Wall::periodic);
        shake(still.position, 0.5f * spacing_m);
        for (float4& place : still.position) {
            glm::vec3 x = grid::xyz(place), v(0);
            keep_inside(still.box, x, v);
            place = make_float4(x.x, x.y, x.z, 0);
        }
        Fluid fluid = sheet_fluid(spacing_m, 10, 1 / reynolds);
        // Pressed by twice rho u^2 / 2, the most that the vortices pull with. Much more would make the
        // particles stiff against passing each other: that is friction too.
        fluid.rest_density_kg_per_m3 *= 0.99f;
        Fluid thick = fluid;
        thick.viscosity_m2_per_s = 0.05f * fluid.support_m * fluid.sound_speed_m_per_s;
        Water settling(thick, still.box, EquationOfState::linear, still.position,
                       at_rest(still.position.size()));
        for (int step = 0; step < 150; ++step) settling.step(time_step_limit(thick).smallest_s());
        const std::vector<float4> position = by_id(settling, settling.positions());
        std::vector<float4> velocity;
        for (const float4& x : position) {
            const glm::dvec2 u = shape(x);
            velocity.push_back(make_float4(float(u.x), float(u.y), 0, 0));
        }
        return Water(fluid, still.box, EquationOfState::linear, position, velocity);
    }
};
//! [taylor_green]

//! [poiseuille]
/// Water between two plates that starts to flow under a constant force.
struct Poiseuille {
    static constexpr double kGap_m = 1e-3, kForce_m_per_s2 = 1e-4, kViscosity_m2_per_s = 1e-6;
    static constexpr double kFastest_m_per_s =
        kForce_m_per_s2 * kGap_m * kGap_m / (8 * kViscosity_m2_per_s);  // 1.25e-5: in the middle, at last

    Water water;
    int steps = 0;

    explicit Poiseuille(int spacings) : water(between_plates(spacings)) {}

    float dt_s() const { return time_step_limit(water.fluid()).smallest_s(); }
    double time_s() const { return steps * double(dt_s()); }
    void run_until(double time) {
        for (; time_s() < time - 0.5 * dt_s(); ++steps) water.step(dt_s());
    }
    /// The series that solves the Navier-Stokes equations here.
    static double exact(double y_m, double time_s, double viscosity_m2_per_s = kViscosity_m2_per_s) {
        const double nu = viscosity_m2_per_s, L = kGap_m, F = kForce_m_per_s2;
        double v = F / (2 * nu) * y_m * (L - y_m);
        for (int n = 1; n < 200; n += 2)
            v -= 4 * F * L * L / (nu * std::pow(n * kPi, 3)) * std::sin(n * kPi * y_m / L) *
                 std::exp(-n * n * kPi * kPi * nu * time_s / (L * L));
        return v;
    }
    /// Largest difference of any particle's velocity from it, over the fastest velocity.
    double error(double viscosity_m2_per_s = kViscosity_m2_per_s) const {
        const auto x = water.positions().download(), v = water.velocities().download();
        double largest = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
            largest = std::fmax(largest, std::abs(v[i].x - exact(x[i].y, time_s(), viscosity_m2_per_s)));
        return largest / kFastest_m_per_s;
    }

  private:
    static Water between_plates(int spacings) {
        const float spacing_m = float(kGap_m / spacings);
        const LatticeBox start = sheet(4, spacings, spacing_m, Wall::no_slip);
        Fluid fluid = sheet_fluid(spacing_m, 10 * kFastest_m_per_s, kViscosity_m2_per_s);
        fluid.gravity_m_per_s2 = {float(kForce_m_per_s2), 0, 0};
        return Water(fluid, start.box, EquationOfState::linear, start.position,
                     at_rest(start.position.size()));
    }
};
//! [poiseuille]

}  // namespace sph
