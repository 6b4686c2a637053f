// Our own code beside the library that does the same: time and peak memory of a frame of 4096 x
// 4096 counts, each in a process of its own. docs/libraries.md has the ratios.
//
//     ninja -C build/release library-ratios && build/release/bin/library-ratios [DIRECTORY]

#include <fcntl.h>
#include <fitsio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>

#include "core/base/error.h"
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

void write_by_cfitsio(const std::string& path, const CountImage& counts, const FrameHeader& header,
                      bool rice) {
  const std::string partial = path + ".partial";
  unlink(partial.c_str());
  fitsfile* file = nullptr;
  int status = 0;
  long shape[2] = {counts.columns, counts.rows}, tile[2] = {counts.columns, 1};
  fits_create_diskfile(&file, partial.c_str(), &status);
  if (rice) {
    fits_set_compression_type(file, RICE_1, &status);
    fits_set_tile_dim(file, 2, tile, &status);
  }
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
  for (const bool rice : {false, true}) {
    const auto kind = rice ? FitsCompression::rice : FitsCompression::none;
    const std::string path = folder + "/library-ratios.fits";
    const Cost ours = cost_of([&] { write_frame(path, counts, header, kind); });
    const Cost theirs = cost_of([&] { write_by_cfitsio(path, counts, header, rice); });
    show(rice ? "FITS, Rice (CFITSIO)" : "FITS (CFITSIO)", ours, theirs);
    unlink(path.c_str());
  }
}
