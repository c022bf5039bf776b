/// @file
/// The pictures of a run: six frames of the fountain's first life on one sheet, and its end.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "01_particle_loop/splat.h"
#include "common/program.h"

namespace particle_loop {

class Film {
  public:
    Film(const course::ProgramOptions& options, const Fountain& fountain)
        : options_(options),
          // After one life, one frame looks like the next.
          steps_per_frame_(std::max(1, std::min(options.steps, int(life_steps(fountain))) / kFrames)) {}

    /// Memory for the pictures of a run: light (12 bytes a pixel), colours (3), and the PNG while it is made.
    static double bytes(const course::ProgramOptions& options) {
        return 20.0 * options.width * options.height;
    }
    /// Is a frame due after so many steps?
    bool wants(int steps_done) const {
        return steps_done % steps_per_frame_ == 0 && frames_.size() < kFrames;
    }
    void take(const std::vector<Particle>& particles, std::uint32_t born) {
        frames_.push_back(picture(particles, born, options_.width / 2, options_.height / 2));
    }
    /// Writes the sheet of the frames taken so far, if there are any.
    void save_sheet(course::Result& result) const {
        if (frames_.empty()) return;
        course::save_png(options_.out / "start.png", course::contact_sheet(frames_, 3));
        result.picture("start.png", "The fountain is switched on");
    }
    void save_end(course::Result& result, const std::vector<Particle>& particles, std::uint32_t born,
                  const std::string& caption) const {
        course::save_png(options_.out / "fountain.png",
                         picture(particles, born, options_.width, options_.height));
        result.picture("fountain.png", caption);
    }

  private:
    static constexpr int kFrames = 6;
    const course::ProgramOptions& options_;
    int steps_per_frame_;
    std::vector<course::Image> frames_;
};

}  // namespace particle_loop
