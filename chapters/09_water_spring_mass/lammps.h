/// @file
/// The same marbles in LAMMPS, a program that many have checked for twenty years: scene files written, the
/// program run, its answer read. Debian has it as package `lammps`.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "09_water_spring_mass/contact.cuh"

namespace spring_mass {

/// Is this program on the search path?
inline bool is_installed(const std::string& program) {
    return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

/// What LAMMPS is to compute. Positions and velocities by marble number.
struct LammpsScene {
    MaterialOf<double> material;
    glm::dvec3 low_m, high_m;
    std::vector<glm::dvec3> position, velocity;
    double dt_s = 0;
    int steps = 0;
    double skin_m = 0;  ///< of its neighbour list
    int warm_up = 0;    ///< steps before those that are counted and timed
};

struct LammpsAnswer {
    std::vector<glm::dvec3> position, velocity;
    double seconds = 0;  ///< its own "Loop time": steps alone, without reading and setting up
};

//! [lammps_script]
/// LAMMPS's input: units that are any consistent ones, forces by `gran/hooke`, six walls, gravity, and `fix
/// nve`, which is the kick-drift-kick of this chapter. Rotation is left out by taking `nve` and not
/// `nve/sphere`.
inline std::string lammps_script(const LammpsScene& scene) {
    const MaterialOf<double>& m = scene.material;
    const double g = glm::length(m.gravity_m_per_s2);
    const glm::dvec3 down = g > 0 ? m.gravity_m_per_s2 / g : glm::dvec3(0, -1, 0);
    // Processes share the box by cuts across the floor: above a bed there is nothing to share.
    int up = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (std::abs(down[axis]) > std::abs(down[up])) up = axis;
    std::ostringstream hooke, script;
    hooke << std::setprecision(17) << m.stiffness_N_per_m << " NULL " << m.normal_damping_per_s << " "
          << m.tangential_damping_per_s << " " << m.friction << " 1";
    script << std::setprecision(17) << "units lj\natom_style sphere\nboundary f f f\nnewton on\n"
           << "comm_modify vel yes\nprocessors "
           << (up == 0   ? "1 * *"
               : up == 1 ? "* 1 *"
                         : "* * 1")
           << "\nread_data scene.data\nset group all mass " << m.mass_kg << "\n"
           << "pair_style gran/hooke " << hooke.str() << "\npair_coeff * *\nneighbor " << scene.skin_m
           << " bin\nneigh_modify delay 0 every 1 check yes\nfix move all nve\n";
    for (int axis = 0; axis < 3; ++axis)
        script << "fix wall" << axis << " all wall/gran hooke " << hooke.str() << " "
               << "xyz"[axis] << "plane " << scene.low_m[axis] << " " << scene.high_m[axis] << "\n";
    script << "fix weight all gravity " << g << " vector " << down.x << " " << down.y << " " << down.z << "\n"
           << "timestep " << scene.dt_s << "\nthermo 1000000\n";
    if (scene.warm_up > 0) script << "run " << scene.warm_up << "\n";
    script << "run " << scene.steps << "\n"
           << "write_dump all custom answer.dump id x y z vx vy vz modify sort id format float %.17g\n";
    return script.str();
}
//! [lammps_script]

/// LAMMPS's data file: how large the box is, then the marbles.
inline std::string lammps_data(const LammpsScene& scene) {
    std::ostringstream data;
    const std::size_t n = scene.position.size();
    data << std::setprecision(17) << "marbles\n\n" << n << " atoms\n1 atom types\n\n";
    for (int axis = 0; axis < 3; ++axis) {
        const char name = "xyz"[axis];
        data << scene.low_m[axis] << " " << scene.high_m[axis] << " " << name << "lo " << name << "hi\n";
    }
    data << "\nAtoms # sphere\n\n";
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec3& x = scene.position[i];
        data << i + 1 << " 1 " << scene.material.diameter_m << " 1 " << x.x << " " << x.y << " " << x.z
             << "\n";
    }
    data << "\nVelocities\n\n";
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec3& v = scene.velocity[i];
        data << i + 1 << " " << v.x << " " << v.y << " " << v.z << " 0 0 0\n";
    }
    return data.str();
}

/// Runs LAMMPS in `folder`. @param ranks  processes that share the work, by MPI if more than 1
/// @throws std::runtime_error with LAMMPS's last words if it gives no answer
inline LammpsAnswer run_lammps(const LammpsScene& scene, const std::filesystem::path& folder, int ranks) {
    std::ofstream(folder / "scene.data") << lammps_data(scene);
    std::ofstream(folder / "scene.in") << lammps_script(scene);
    // One thread a rank. Open MPI refuses to start as root, which is what one is in a container, unless told.
    std::string command = "cd '" + folder.string() +
                          "' && export OMP_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 "
                          "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 && ";
    if (ranks > 1) command += "mpirun --oversubscribe --bind-to none -np " + std::to_string(ranks) + " ";
    command += "lmp -in scene.in -log none 2>&1";
    LammpsAnswer answer;
    std::string output;
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) throw std::runtime_error("LAMMPS could not be started");
    for (char line[512]; std::fgets(line, sizeof line, pipe);) {
        output += line;
        std::sscanf(line, "Loop time of %lf", &answer.seconds);  // of several runs the last
    }
    const bool good = pclose(pipe) == 0;
    std::ifstream dump(folder / "answer.dump");
    std::string line;
    while (std::getline(dump, line) && line.rfind("ITEM: ATOMS", 0) != 0) {
    }
    long id;
    for (glm::dvec3 x, v; dump >> id >> x.x >> x.y >> x.z >> v.x >> v.y >> v.z;) {
        answer.position.push_back(x);
        answer.velocity.push_back(v);
    }
    if (!good || answer.position.size() != scene.position.size())
        throw std::runtime_error("LAMMPS gave no answer; its last words: " +
                                 output.substr(output.size() > 400 ? output.size() - 400 : 0));
    return answer;
}

}  // namespace spring_mass
