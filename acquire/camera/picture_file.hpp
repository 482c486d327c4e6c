// One picture file, read strictly: half a picture is no picture.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "common/result.hpp"

namespace linescope {

/// True for the endings that count as pictures: png, jpg, jpeg, bmp, tif, tiff, pgm, ppm, webp (any case).
bool looks_like_picture(const std::filesystem::path& file);

/// 8 bit BGR as it lies in the file: no turning by EXIF, because a calibration belongs to the sensor's own
/// rows and columns. `unreadable` when the file is empty, broken or cut off (decoders fill the missing part
/// of a cut JPEG with grey and report success; here it is refused).
/// @param buffer  the file's bytes, memory used again from call to call
Result<cv::Mat> read_picture(const std::filesystem::path& file, std::vector<unsigned char>& buffer);

}  // namespace linescope
