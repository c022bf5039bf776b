#include "common/files.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "common/errors.h"

namespace course {

void write_file(const std::filesystem::path& path, const void* bytes, std::size_t count) {
    const std::string temporary = path.string() + ".part" + std::to_string(getpid());
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    if (!file) throw BadInput("cannot write " + path.string() + ": " + std::strerror(errno));
    // A full disk may show only when the buffer is flushed, so fclose counts too.
    const bool written = std::fwrite(bytes, 1, count, file) == count;
    const bool closed = std::fclose(file) == 0;
    if (!written || !closed || std::rename(temporary.c_str(), path.c_str()) != 0) {
        const std::string reason = std::strerror(errno);
        std::remove(temporary.c_str());
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
