// How to keep pictures without loss: our codec beside PNG, FFV1 and HuffYUV, on laser pictures. The figures
// are in docs/recording.md: time per picture, and size as a share of the raw pixels.
//
//   bench_recording [--benchmark_...]        pictures of a synthetic laser line
//   LINESCOPE_PICTURES=FOLDER bench_recording   pictures of that folder
#include <benchmark/benchmark.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "acquire/camera/picture_folder.hpp"
#include "acquire/record/picture_codec.hpp"
#include "acquire/record/recorded_items.hpp"

namespace linescope {
namespace {

/// A bright noisy line over a dark noisy gradient, 640x480.
cv::Mat synthetic(int i) {
  cv::Mat picture(480, 640, CV_8UC3);
  for (int y = 0; y < picture.rows; ++y)
    picture.row(y).setTo(cv::Scalar(20 + y / 16, 25 + y / 12, 30 + y / 10));
  cv::line(picture, {0, 200 + 3 * i}, {639, 260 - 2 * i}, {90, 250, 120}, 5, cv::LINE_AA);
  cv::GaussianBlur(picture, picture, {}, 1.5);
  cv::Mat noise(picture.size(), CV_16SC3), wide;
  cv::RNG rng(static_cast<std::uint64_t>(i) + 1);
  rng.fill(noise, cv::RNG::NORMAL, 0, 2);
  picture.convertTo(wide, CV_16SC3);
  cv::add(wide, noise, wide);
  wide.convertTo(picture, CV_8UC3);
  return picture;
}

std::vector<cv::Mat> from_folder(const char* folder) {
  std::vector<cv::Mat> pictures;
  PictureFolder source({.folder = folder});
  Frame frame;
  if (!source.start()) return pictures;
  for (;;) {
    const auto pull = source.next(frame);
    if (pull && *pull == Pull::end) return pictures;
    if (pull) pictures.push_back(frame.bgr.clone());
  }
}

const std::vector<cv::Mat>& pictures() {
  static const std::vector<cv::Mat> all = [] {
    if (const char* folder = std::getenv("LINESCOPE_PICTURES")) return from_folder(folder);
    std::vector<cv::Mat> made;
    for (int i = 0; i < 20; ++i) made.push_back(synthetic(i));
    return made;
  }();
  return all;
}

double raw_bytes() {
  double bytes = 0;
  for (const cv::Mat& picture : pictures())
    bytes += static_cast<double>(picture.total() * picture.elemSize());
  return bytes;
}

void report(benchmark::State& state, double bytes) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pictures().size()));
  state.counters["size"] = bytes / raw_bytes();
}

void encode_ours(benchmark::State& state, PictureEncoding encoding) {
  PictureCodec codec;
  Bytes bytes;
  double size = 0;
  for (auto _ : state) {
    size = 0;
    for (const cv::Mat& picture : pictures()) {
      bytes.clear();
      codec.encode(picture, encoding, bytes);
      size += static_cast<double>(bytes.size());
    }
  }
  report(state, size);
}

void decode_ours(benchmark::State& state) {
  PictureCodec codec;
  std::vector<Bytes> coded(pictures().size());
  for (std::size_t i = 0; i < coded.size(); ++i)
    codec.encode(pictures()[i], PictureEncoding::row_zstd, coded[i]);
  cv::Mat back;
  for (auto _ : state) {
    for (std::size_t i = 0; i < coded.size(); ++i) {
      const cv::Mat& picture = pictures()[i];
      if (!codec.decode(coded[i], PictureEncoding::row_zstd, picture.cols, picture.rows, back))
        state.SkipWithError("bad");
    }
  }
  report(state, 0);
}

void encode_png(benchmark::State& state) {
  std::vector<unsigned char> bytes;
  double size = 0;
  for (auto _ : state) {
    size = 0;
    for (const cv::Mat& picture : pictures()) {
      cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
      size += static_cast<double>(bytes.size());
    }
  }
  report(state, size);
}

/// A whole file per round, as OpenCV offers nothing smaller.
void encode_video(benchmark::State& state, const char* fourcc, const char* ending) {
  const auto file = std::filesystem::temp_directory_path() / ("bench_recording" + std::string(ending));
  const int code = cv::VideoWriter::fourcc(fourcc[0], fourcc[1], fourcc[2], fourcc[3]);
  for (auto _ : state) {
    cv::VideoWriter writer(file.string(), cv::CAP_FFMPEG, code, 30, pictures().front().size());
    if (!writer.isOpened()) state.SkipWithError("this FFmpeg has no such codec");
    for (const cv::Mat& picture : pictures()) writer.write(picture);
  }
  report(state, static_cast<double>(std::filesystem::file_size(file)));
  std::filesystem::remove(file);
}

/// Writes 90 pictures (3 s) in a child that is killed the hard way, and counts what can be read of them.
template <class Write, class Count>
void kill_writer(benchmark::State& state, Write write, Count count) {
  double lost = 0;
  for (auto _ : state) {
    const pid_t child = ::fork();
    if (child == 0) {
      write();
      ::raise(SIGKILL);
    }
    ::waitpid(child, nullptr, 0);
    lost = 90 - count();
  }
  state.counters["pictures_lost"] = lost;
}

void kill_video(benchmark::State& state, const char* fourcc, const char* ending) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("bench_killed" + std::string(ending))).string();
  const int code = cv::VideoWriter::fourcc(fourcc[0], fourcc[1], fourcc[2], fourcc[3]);
  kill_writer(
      state,
      [&] {
        static cv::VideoWriter writer(file, cv::CAP_FFMPEG, code, 30, pictures().front().size());
        for (std::size_t i = 0; i < 90; ++i) writer.write(pictures()[i % pictures().size()]);
      },
      [&] {
        cv::VideoCapture capture(file, cv::CAP_FFMPEG);
        int read = 0;
        for (cv::Mat picture; capture.read(picture);) ++read;
        return read;
      });
  std::filesystem::remove(file);
}

void kill_ours(benchmark::State& state) {
  const auto file = std::filesystem::temp_directory_path() / "bench_killed.lsrec";
  kill_writer(
      state,
      [&] {
        std::filesystem::remove(file);
        RecordWriter writer(*create_record_file(file), RecordFileKind::pictures);
        PictureCodec codec;
        for (std::uint64_t i = 0; i < 90; ++i) {
          add_record(writer, {pictures()[i % pictures().size()], 0, i, ""}, PictureEncoding::row_zstd, codec);
          if (!writer.flush()) ::_exit(1);
        }
      },
      [&] {
        auto reader = RecordReader::open(file, RecordFileKind::pictures);
        int read = 0;
        for (Record record; reader && reader->next(record).value_or(Pull::end) == Pull::item;) ++read;
        return read;
      });
  std::filesystem::remove(file);
}

BENCHMARK_CAPTURE(encode_ours, row_zstd, PictureEncoding::row_zstd)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encode_ours, plain, PictureEncoding::plain)->Unit(benchmark::kMillisecond);
BENCHMARK(encode_png)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encode_video, ffv1_mkv, "FFV1", ".mkv")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encode_video, huffyuv_avi, "HFYU", ".avi")->Unit(benchmark::kMillisecond);
BENCHMARK(decode_ours)->Unit(benchmark::kMillisecond);
BENCHMARK(kill_ours)->Iterations(1);
BENCHMARK_CAPTURE(kill_video, ffv1_mkv, "FFV1", ".mkv")->Iterations(1);
BENCHMARK_CAPTURE(kill_video, huffyuv_avi, "HFYU", ".avi")->Iterations(1);

}  // namespace
}  // namespace linescope

BENCHMARK_MAIN();
