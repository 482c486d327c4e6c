#include "acquire/camera/picture_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <string_view>

namespace linescope {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::array<std::string_view, 9> kEndings{".png",  ".jpg", ".jpeg", ".bmp", ".tif",
                                                   ".tiff", ".pgm", ".ppm",  ".webp"};

bool read_bytes(const std::filesystem::path& file, Bytes& bytes) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream) return false;
  bytes.resize(static_cast<std::size_t>(std::max<std::streamoff>(stream.tellg(), 0)));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return stream.good() || bytes.empty();
}

Bytes::const_iterator last_marker(const Bytes& bytes, unsigned char code) {
  const std::array<unsigned char, 2> marker{0xFF, code};
  return std::find_end(bytes.begin(), bytes.end(), marker.begin(), marker.end());
}

bool is_jpeg(const Bytes& bytes) {
  return bytes.size() > 2 && bytes[0] == 0xFF && bytes[1] == 0xD8;
}

/// Inside compressed data 0xFF is always followed by 0, so the last "start of scan" comes before the last
/// "end of image" exactly when the last scan is whole.
bool jpeg_is_whole(const Bytes& bytes) {
  const auto end_of_image = last_marker(bytes, 0xD9);
  return end_of_image != bytes.end() && last_marker(bytes, 0xDA) < end_of_image;
}

cv::Mat decode(const Bytes& bytes) {
  try {
    return cv::imdecode(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};
  }
}

tl::unexpected<Error> unreadable(const std::filesystem::path& file, std::string_view why) {
  return fail(ErrorCode::unreadable, fmt::format("picture {} {}; it is passed over", file.string(), why));
}

}  // namespace

bool looks_like_picture(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

Result<cv::Mat> read_picture(const std::filesystem::path& file, std::vector<unsigned char>& buffer) {
  if (!read_bytes(file, buffer)) return unreadable(file, "cannot be opened");
  if (buffer.empty()) return unreadable(file, "is an empty file");
  if (is_jpeg(buffer) && !jpeg_is_whole(buffer)) return unreadable(file, "is cut off");
  cv::Mat picture = decode(buffer);
  if (picture.empty()) return unreadable(file, "is broken or not a picture");
  return picture;
}

}  // namespace linescope
