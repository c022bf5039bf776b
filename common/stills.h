/// @file
/// The pictures of a run: each still as a file, and all of them on one sheet.
#pragma once
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "common/image.h"
#include "common/program.h"

namespace course {

/// Six digits, so that files sort by step.
inline std::string file_number(int number) {
    char text[16];
    std::snprintf(text, sizeof text, "%06d", number);
    return text;
}

/// Stills are written as they come: what a run that fails has shown stays.
class Stills {
  public:
    explicit Stills(Program& program) : program_(program) {}

    bool empty() const { return small_.empty(); }
    void add(const Image& image, int step, double time_s) {
        const std::string file = "still_" + file_number(step) + ".png";
        save_png(program_.options.out / file, image);
        captions_.push_back({file, format_number(time_s) + " s, step " + std::to_string(step)});
        small_.push_back(half_size(image));
    }
    /// The sheet, and all files into the result; also when the run ends by an error.
    void finish() {
        if (empty()) return;
        save_png(program_.options.out / "time_lapse.png", contact_sheet(small_, 3));
        program_.result().picture("time_lapse.png", "Time lapse, row by row");
        for (const auto& [file, caption] : captions_) program_.result().picture(file, caption);
    }

  private:
    Program& program_;
    std::vector<Image> small_;
    std::vector<std::pair<std::string, std::string>> captions_;
};

}  // namespace course
