/// @file
/// Pictures of a run as a film: through ffmpeg where it is installed, else as single PNG files.
#pragma once
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include "common/errors.h"
#include "common/files.h"
#include "common/image.h"

namespace water {

/// The first executable of that name in the folders of PATH; empty if there is none.
inline std::filesystem::path find_program(const std::string& name) {
    const char* all = std::getenv("PATH");
    std::istringstream folders(all ? all : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::filesystem::path path = std::filesystem::path(folder) / name;
        if (!folder.empty() && access(path.c_str(), X_OK) == 0) return path;
    }
    return {};
}

/// One argument for the shell, whatever is in it.
inline std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

/// A film while it is made. Until finish() it has another name: a run that ends early leaves no half film.
class Recording {
  public:
    /// @param file  ends in .mp4 or .gif
    /// @throws course::BadInput if it does not, or the folder can't be written
    Recording(const std::filesystem::path& file, int width_px, int height_px, int frames_per_s)
        : file_(file), part_(file.string() + ".part") {
        const std::string kind = file.extension().string();
        if (kind != ".mp4" && kind != ".gif")
            throw course::BadInput("--record writes .mp4 or .gif, not '" + file.string() + "'");
        if (width_px % 2 || height_px % 2)
            throw course::BadInput(
                "--record needs an even width and height: films store colour for 2 x 2 pixels");
        const std::filesystem::path ffmpeg = find_program("ffmpeg");
        if (ffmpeg.empty()) {
            frames_ = file;
            frames_.replace_extension("");
            course::make_writable_folder(frames_);
            return;
        }
        course::make_writable_folder(file.parent_path().empty() ? "." : file.parent_path());
        const std::string how =
            kind == ".mp4" ? "-c:v libx264 -pix_fmt yuv420p -crf 18 -movflags +faststart -f mp4 "
                           : "-filter_complex '[0:v]split[a][b];[a]palettegen[p];[b][p]paletteuse' -f gif ";
        const std::string command = quoted(ffmpeg.string()) +
                                    " -loglevel error -y -f rawvideo -pix_fmt rgb24 -s " +
                                    std::to_string(width_px) + "x" + std::to_string(height_px) + " -r " +
                                    std::to_string(frames_per_s) + " -i - " + how + quoted(part_.string());
        std::signal(SIGPIPE, SIG_IGN);  // if ffmpeg ends early, a write is to fail, not this program
        pipe_ = popen(command.c_str(), "w");
        if (!pipe_) throw course::BadInput("ffmpeg can't be started");
    }
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;
    ~Recording() {
        if (!pipe_) return;
        pclose(pipe_);
        std::error_code ignored;
        std::filesystem::remove(part_, ignored);
    }

    void add(const course::Image& picture) {
        ++count_;
        if (!pipe_) {
            char name[32];
            std::snprintf(name, sizeof name, "frame_%06d.png", count_);
            course::save_png(frames_ / name, picture);
            return;
        }
        if (std::fwrite(picture.rgb.data(), 1, picture.rgb.size(), pipe_) != picture.rgb.size()) give_up();
    }

    /// The film gets its name. @returns a sentence for the user
    std::string finish() {
        if (!pipe_)
            return "ffmpeg is not installed (Debian: ffmpeg), so the " + std::to_string(count_) +
                   " frames are PNG files in " + frames_.string();
        const int status = pclose(pipe_);
        pipe_ = nullptr;
        if (status != 0) give_up();
        std::filesystem::rename(part_, file_);
        return "film of " + std::to_string(count_) + " frames: " + file_.string();
    }

  private:
    [[noreturn]] void give_up() {
        if (pipe_) pclose(pipe_);
        pipe_ = nullptr;
        std::error_code ignored;
        std::filesystem::remove(part_, ignored);
        throw course::BadInput("ffmpeg could not write " + file_.string() + " (its own words are above)");
    }

    std::filesystem::path file_, part_, frames_;
    std::FILE* pipe_ = nullptr;
    int count_ = 0;
};

}  // namespace water
