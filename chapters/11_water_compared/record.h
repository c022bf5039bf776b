/// @file
/// One run of the experiment: what it is asked to do, what it measured, and the file that keeps it. A run
/// that has its file is done, so an experiment that was interrupted goes on where it stopped.
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/errors.h"
#include "common/files.h"

/// Chapter 11: the two waters, compared.
namespace compared {

enum class Model { spring_mass, sph };

inline std::string name_of(Model model) {
    return model == Model::sph ? "SPH" : "spring-mass";
}

//! [RunPlan]
/// Everything that the numbers of a run depend on, the machine aside.
struct RunPlan {
    Model model = Model::sph;
    int exponent = 14;    ///< 2^exponent particles
    int run = 0;          ///< which repeat of the same size
    int steps = 600;      ///< of that run
    int samples = 40;     ///< looks at the particles, evenly over the steps
    float stiffness = 1;  ///< factor on the model's own: sound speed squared, or spring constant
    float dt_factor = 1;  ///< time step / the largest that the model allows
    std::uint64_t seed = 1;

    std::uint32_t particles() const { return 1u << exponent; }
};
//! [RunPlan]

/// How things stand at one step. Neighbours and cells are counted at the same distance for both models, two
/// particle spacings; partners are what the model itself computes with: particles in the support radius, or
/// in contact.
struct Sample {
    int step = 0;
    double seconds = 0;          ///< of a step, mean since the sample before
    double mean_neighbours = 0;  ///< of a particle
    std::uint32_t most_neighbours = 0;
    std::uint32_t fullest_cell = 0;  ///< particles in it
    double mean_partners = 0;        ///< of a particle: interactions per step / particles
    double mean_height_m = 0;        ///< of all particles over the floor
};

/// What a run measured.
struct RunRecord {
    RunPlan plan;
    std::string device;
    double dt_s = 0;
    double seconds_per_step = 0;                         ///< mean over all steps
    std::vector<std::pair<std::string, double>> passes;  ///< seconds of each pass in a step, mean of samples
    std::vector<Sample> samples;
};

//! [files]
/// "sph_2e14_k1_dt1_run00.json"; another stiffness or time step is another file.
inline std::filesystem::path file_of(const std::filesystem::path& folder, const RunPlan& plan) {
    char name[128];
    std::snprintf(name, sizeof name, "%s_2e%d_k%g_dt%g_run%02d.json",
                  plan.model == Model::sph ? "sph" : "spring_mass", plan.exponent, plan.stiffness,
                  plan.dt_factor, plan.run);
    return folder / name;
}

inline nlohmann::json json_of(const RunPlan& plan) {
    return {{"model", name_of(plan.model)}, {"exponent", plan.exponent}, {"run", plan.run},
            {"steps", plan.steps},          {"samples", plan.samples},   {"stiffness", plan.stiffness},
            {"dt_factor", plan.dt_factor},  {"seed", plan.seed}};
}

/// Written whole or not at all.
inline void save(const std::filesystem::path& folder, const RunRecord& record) {
    nlohmann::json json = {{"plan", json_of(record.plan)},
                           {"device", record.device},
                           {"dt_s", record.dt_s},
                           {"seconds_per_step", record.seconds_per_step}};
    for (const auto& [name, seconds] : record.passes)
        json["passes"].push_back({{"name", name}, {"seconds", seconds}});
    for (const Sample& s : record.samples)
        json["samples"].push_back({{"step", s.step},
                                   {"seconds", s.seconds},
                                   {"mean_neighbours", s.mean_neighbours},
                                   {"most_neighbours", s.most_neighbours},
                                   {"fullest_cell", s.fullest_cell},
                                   {"mean_partners", s.mean_partners},
                                   {"mean_height_m", s.mean_height_m}});
    course::write_file(file_of(folder, record.plan), json.dump(1) + "\n");
}

/// Is that run done? Then its record is filled in.
/// A file of another experiment (other steps, another seed, another device) is not: the run is made anew.
/// @throws course::BadInput if there is a file by that name which is no record
inline bool load(const std::filesystem::path& folder, const RunPlan& plan, const std::string& device,
                 RunRecord& record) {
    const std::filesystem::path file = file_of(folder, plan);
    std::ifstream in(file);
    if (!in) return false;
    try {
        const nlohmann::json json = nlohmann::json::parse(in);
        if (json.at("plan") != json_of(plan) || json.at("device") != device) return false;
        record = {plan, device, json.at("dt_s"), json.at("seconds_per_step"), {}, {}};
        for (const auto& pass : json.at("passes"))
            record.passes.emplace_back(pass.at("name"), pass.at("seconds"));
        for (const auto& s : json.at("samples"))
            record.samples.push_back({s.at("step"), s.at("seconds"), s.at("mean_neighbours"),
                                      s.at("most_neighbours"), s.at("fullest_cell"), s.at("mean_partners"),
                                      s.at("mean_height_m")});
        return true;
    } catch (const nlohmann::json::exception&) {
        throw course::BadInput(file.string() +
                               " is not a finished run: delete it to have the run made again");
    }
}
//! [files]

}  // namespace compared
