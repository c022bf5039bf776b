/// @file
/// A picture in memory, and as a PNG file.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

namespace course {

/// 8-bit sRGB picture, three bytes a pixel, top row first.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;  ///< width * height * 3 bytes

    Image() = default;
    Image(int width_px, int height_px) : width(width_px), height(height_px), rgb(3u * width_px * height_px) {}
    std::uint8_t* pixel(int x, int y) { return &rgb[3 * (std::size_t(y) * width + x)]; }
    const std::uint8_t* pixel(int x, int y) const { return &rgb[3 * (std::size_t(y) * width + x)]; }
};

/// Linear light in [0, 1] (values outside are clamped) to an 8-bit sRGB value (IEC 61966-2-1).
std::uint8_t to_srgb(float linear);

/// Writes a PNG. @throws BadInput if the file can't be written.
void save_png(const std::filesystem::path& path, const Image& image);

/// Half the width and height, each pixel the mean of four (in sRGB values: good enough for thumbnails).
Image half_size(const Image& image);

/// Places equal-sized pictures row by row, `columns` to a row, `gap_px` of dark background between them.
Image contact_sheet(const std::vector<Image>& images, int columns, int gap_px = 4);

}  // namespace course
