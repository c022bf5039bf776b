/// @file
/// Plots of studies and stability maps by gnuplot, as SVG and PNG. Each method has its own colour (of Okabe
/// and Ito's palette, which colour-blind readers can tell apart), mark and dashes, so that print in grey is
/// readable too.
#pragma once
#include <filesystem>
#include <string>

#include "common/report/measurements.h"

namespace course::report {

/// The commands that make gnuplot draw it, without terminal and output file.
std::string plot_script(const StudyData& study);
std::string plot_script(const StabilityData& data);

/// Writes STEM.svg and STEM.png.
/// @throws std::runtime_error if gnuplot is not there or refuses the script
void draw(const std::string& script, const std::filesystem::path& stem, int height_px);

/// Panels of a stability map are stacked in rows of three: so many pixels high.
int height_of(const StabilityData& data);
constexpr int kStudyHeight = 520;

}  // namespace course::report
