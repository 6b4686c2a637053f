// Our own code beside the library that does the same: time and peak memory for a frame of 4096 x
// 4096 counts, each in a process of its own, the best of five. docs/libraries.md has the ratios.
//
//     ninja -C build/release library-ratios && build/release/bin/library-ratios [DIRECTORY]

#include <Random123/philox.h>
#include <fcntl.h>
#include <fitsio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>
#if __has_include(<eigen3/Eigen/QR>)
#include <eigen3/Eigen/QR>
#endif

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "core/base/algebra/least_squares.h"
#include "core/base/error.h"
#include "core/base/files/crc32c.h"
#include "core/base/files/json.h"
#include "core/base/numeric/rng.h"
#include "core/detector/noise/poisson.h"
#include "core/image/fits_cards.h"
#include "core/image/fits_file.h"
#include "tests/image/sample_frame.h"

using namespace dmise;

namespace {

constexpr int side = 4096, repeats = 5;

struct Cost {
  double seconds = 0.0, mb = 0.0;
};

/// Best time of `work`, and what it adds to the peak memory of a process that holds the frame.
Cost cost_of(const std::function<void()>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw Error("no pipe");
  if (fork() == 0) {
    rusage before{}, after{};
    getrusage(RUSAGE_SELF, &before);
    Cost cost{1e9, 0.0};
    for (int i = 0; i < repeats; ++i) {
      const auto start = std::chrono::steady_clock::now();
      work();
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
      cost.seconds = std::min(cost.seconds, took.count());
    }
    getrusage(RUSAGE_SELF, &after);
    cost.mb = double(after.ru_maxrss - before.ru_maxrss) / 1024.0;
    _exit(write(ends[1], &cost, sizeof cost) == sizeof cost ? 0 : 1);
  }
  Cost cost;
  int status = 0;
  wait(&status);
  if (status != 0 || read(ends[0], &cost, sizeof cost) != sizeof cost) throw Error("it failed");
  close(ends[0]);
  close(ends[1]);
  return cost;
}

void write_by_cfitsio(const std::string& path, const CountImage& counts,
                      const FrameHeader& header) {
  const std::string partial = path + ".partial";
  unlink(partial.c_str());
  fitsfile* file = nullptr;
  int status = 0;
  long shape[2] = {counts.columns, counts.rows};
  fits_create_diskfile(&file, partial.c_str(), &status);
  fits_create_img(file, USHORT_IMG, 2, shape, &status);
  for (const auto& card : fits_cards(header)) fits_write_record(file, card.c_str(), &status);
  fits_write_img(file, TUSHORT, 1, LONGLONG(counts.pixels.size()),
                 const_cast<std::uint16_t*>(counts.pixels.data()), &status);
  fits_close_file(file, &status);
  const int descriptor = open(partial.c_str(), O_RDONLY);
  if (status != 0 || descriptor < 0 || fsync(descriptor) != 0 ||
      rename(partial.c_str(), path.c_str()) != 0)
    throw Error("CFITSIO: status " + std::to_string(status));
  close(descriptor);
}

void show(const char* what, const Cost& ours, const Cost& theirs) {
  std::printf("%-34s ours %7.1f ms %6.1f MB   library %7.1f ms %6.1f MB   ratio %5.2f %6.2f\n",
              what, 1e3 * ours.seconds, ours.mb, 1e3 * theirs.seconds, theirs.mb,
              theirs.seconds / ours.seconds, theirs.mb / std::max(ours.mb, 0.1));
}

/// Numbers drawn for every pixel of the frame.
void random_numbers() {
  std::vector<std::uint32_t> words(std::size_t(side) * side);
  std::vector<float> counts(words.size());
  const RngKey key = rng_key(1, "sensor", 1, "effect");
  const Cost ours = cost_of([&] { rng_words(key, 0, words.size(), 0, words.data()); });
  const Cost theirs = cost_of([&] {
    const r123::Philox4x32 philox;
    for (std::uint32_t i = 0; i < words.size(); i += 4) {
      const auto four =
          philox({{i / 4, 0, key.stream[0], key.stream[1]}}, {{key.key[0], key.key[1]}});
      std::copy(four.begin(), four.end(), words.begin() + i);
    }
  });
  show("random words (Random123's loop)", ours, theirs);
  for (const float mean : {5.0f, 300.0f}) {
    const std::vector<float> means(counts.size(), mean);
    const Cost drawn = cost_of([&] { poisson(key, 0, means.data(), means.size(), counts.data()); });
    const Cost standard = cost_of([&] {
      std::mt19937_64 engine(1);
      std::poisson_distribution<int> distribution(mean);
      for (float& count : counts) count = float(distribution(engine));
    });
    show(mean < 24 ? "Poisson, mean 5 (libstdc++)" : "Poisson, mean 300 (libstdc++)", drawn,
         standard);
  }
}

void checksums() {
  const std::string bytes(64 << 20, 'x');
  volatile std::uint32_t sum = 0;
  const Cost ours = cost_of([&] { sum = crc32c(bytes.data(), bytes.size()); });
  const Cost theirs = cost_of([&] {
    sum = std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), uInt(bytes.size())));
  });
  show("checksum of 64 MB (zlib's crc32)", ours, theirs);
}

/// Lines as those of truth.
void json_lines() {
  constexpr int lines = 50'000, numbers = 12;
  volatile std::size_t size = 0;
  const Cost ours = cost_of([&] {
    for (int i = 0; i < lines; ++i) {
      JsonWriter json;
      json.begin_object().field("sensor", "atlanta").field("frame", i);
      for (int k = 0; k < numbers; ++k) json.field("value", 1.0 / (i + k + 1));
      size = json.end_object().take().size();
    }
  });
  const Cost theirs = cost_of([&] {
    for (int i = 0; i < lines; ++i) {
      nlohmann::ordered_json json{{"sensor", "atlanta"}, {"frame", i}};
      for (int k = 0; k < numbers; ++k) json["value" + std::to_string(k)] = 1.0 / (i + k + 1);
      size = json.dump().size();
    }
  });
  show("50,000 lines of JSON (nlohmann)", ours, theirs);
}

#if __has_include(<eigen3/Eigen/QR>)
/// A WCS of order 9: 24 x 24 samples, 55 terms, two right-hand sides.
void fits() {
  constexpr int rows = 576, columns = 55, times = 100;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Matrix a = Matrix::Random(rows, columns), b = Matrix::Random(rows, 2);
  volatile double first = 0.0;
  const Cost ours = cost_of([&] {
    for (int i = 0; i < times; ++i)
      first = least_squares({a.data(), a.data() + a.size()}, columns,
                            {b.data(), b.data() + b.size()}, 2)[0];
  });
  const Cost theirs = cost_of([&] {
    for (int i = 0; i < times; ++i) {
      const Eigen::MatrixXd left = a, right = b;
      first = Eigen::MatrixXd(left.householderQr().solve(right))(0, 0);
    }
  });
  show("100 least squares 576 x 55 (Eigen)", ours, theirs);
}
#else
void fits() { std::printf("least squares: needs Debian's libeigen3-dev\n"); }
#endif

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "/tmp";
  CountImage counts(side, side);
  std::uint32_t state = 1;
  for (auto& v : counts.pixels) {  // a sky of 300 with a noise of 18
    int sum = 0;
    for (int i = 0; i < 4; ++i) sum += int((state = state * 1664525u + 1013904223u) >> 27);
    v = std::uint16_t(300 + sum - 62);
  }
  const FrameHeader header = test::sample_header(side, side);
  const std::string path = folder + "/library-ratios.fits";
  show("FITS without compression (CFITSIO)", cost_of([&] { write_frame(path, counts, header); }),
       cost_of([&] { write_by_cfitsio(path, counts, header); }));
  unlink(path.c_str());
  random_numbers();
  checksums();
  json_lines();
  fits();
}
