/// @file
/// Writing files so that nothing is lost: a file is either the old one or the whole new one.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

namespace course {

/// Writes `bytes` to `path` through a temporary file beside it and a rename. A link is followed; what is no
/// regular file (a pipe, /dev/stdout) is written into as it is.
/// @throws BadInput naming the file and the system's reason; an older file at `path` is then still whole.
void write_file(const std::filesystem::path& path, const void* bytes, std::size_t count);
void write_file(const std::filesystem::path& path, const std::string& text);

/// Makes the folder and its parents if they are not there, and proves that a file can be written in it.
/// @throws BadInput naming the folder and the reason.
void make_writable_folder(const std::filesystem::path& folder);

}  // namespace course
