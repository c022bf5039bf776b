#include "common/image.h"

#include <algorithm>
#include <cmath>

#include "common/errors.h"
#include "common/files.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

namespace course {

std::uint8_t to_srgb(float linear) {
    const float v = std::clamp(linear, 0.0f, 1.0f);
    const float encoded = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
    return std::uint8_t(encoded * 255.0f + 0.5f);
}

void save_png(const std::filesystem::path& path, const Image& image) {
    std::string bytes;
    const auto append = [](void* out, void* data, int size) {
        static_cast<std::string*>(out)->append(static_cast<const char*>(data), size);
    };
    if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(),
                                3 * image.width))
        throw BadInput("cannot encode " + path.string() + " as PNG");
    write_file(path, bytes);
}

Image half_size(const Image& image) {
    Image half(image.width / 2, image.height / 2);
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x)
            for (int c = 0; c < 3; ++c)
                half.pixel(x, y)[c] = std::uint8_t(
                    (image.pixel(2 * x, 2 * y)[c] + image.pixel(2 * x + 1, 2 * y)[c] +
                     image.pixel(2 * x, 2 * y + 1)[c] + image.pixel(2 * x + 1, 2 * y + 1)[c] + 2) /
                    4);
    return half;
}

Image contact_sheet(const std::vector<Image>& images, int columns, int gap_px) {
    if (images.empty()) return {};
    const int width = images[0].width, height = images[0].height;
    const int rows = (int(images.size()) + columns - 1) / columns;
    Image sheet(columns * (width + gap_px) - gap_px, rows * (height + gap_px) - gap_px);
    std::fill(sheet.rgb.begin(), sheet.rgb.end(), std::uint8_t(24));
    for (int k = 0; k < int(images.size()); ++k)
        for (int y = 0; y < height; ++y)
            std::copy_n(images[k].pixel(0, y), 3 * width,
                        sheet.pixel(k % columns * (width + gap_px), k / columns * (height + gap_px) + y));
    return sheet;
}

}  // namespace course
