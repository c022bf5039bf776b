#include "common/files.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "common/errors.h"

namespace course {

void write_file(const std::filesystem::path& wanted, const void* bytes, std::size_t count) {
    std::error_code ignored;
    std::filesystem::path path = std::filesystem::weakly_canonical(wanted, ignored);  // follows links
    if (path.empty()) path = wanted;
    const bool special =
        std::filesystem::exists(wanted, ignored) && !std::filesystem::is_regular_file(wanted, ignored);
    const std::string temporary =
        special ? wanted.string() : path.string() + ".part" + std::to_string(getpid());
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    if (!file) throw BadInput("cannot write " + path.string() + ": " + std::strerror(errno));
    // A full disk may show only when the buffer is flushed, so fclose counts too.
    const bool written = std::fwrite(bytes, 1, count, file) == count;
    const bool closed = std::fclose(file) == 0;
    if (!written || !closed || (!special && std::rename(temporary.c_str(), path.c_str()) != 0)) {
        const std::string reason = std::strerror(errno);
        if (!special) std::remove(temporary.c_str());
        throw BadInput("cannot write " + path.string() + ": " + reason);
    }
}

void write_file(const std::filesystem::path& path, const std::string& text) {
    write_file(path, text.data(), text.size());
}

void make_writable_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder))
        throw BadInput("cannot make the folder " + folder.string() + ": " +
                       (error ? error.message() : "a file of that name is in the way"));
    const std::filesystem::path probe = folder / (".writable" + std::to_string(getpid()));
    write_file(probe, std::string{});
    std::filesystem::remove(probe, error);
}

}  // namespace course
