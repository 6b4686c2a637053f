#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/digest.h"
#include "core/base/numeric/rng.h"
#include "core/optics/blur/deposit.h"
#include "core/sky/sky_grid.h"
#include "sensors/render/render_module.h"
#include "tests/support/command.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

SceneRenderer& renderer() {
  static const auto loaded = load_scene_renderer();
  return *loaded;
}

ScenePlane plane_of(ExpectedElectronImage& image) {
  return {image.pixels.data(), image.columns, image.rows, image.columns};
}

ExpectedElectronImage drawn(const std::vector<ScenePoint>& points, double sigma, int columns,
                            int rows) {
  ExpectedElectronImage image(columns, rows);
  renderer().add_points(points, sigma, plane_of(image));
  return image;
}

ExpectedElectronImage deposited(const std::vector<ScenePoint>& points, double sigma, int columns,
                                int rows) {
  ExpectedElectronImage image(columns, rows);
  std::vector<Arc> arcs;
  for (const auto& p : points) {
    const PixelPosition at{p.x, p.y};
    arcs.push_back({at, at, at, p.light, 0.0});
  }
  Threads one;
  deposit(arcs, make_psf_table(sigma), view_of(image), one);
  return image;
}

struct Moments {
  double light = 0, x = 0, y = 0;
};

Moments moments(const ExpectedElectronImage& image) {
  Moments m;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.columns; ++x) {
      const double light = image.at(x, y);
      m.light += light;
      m.x += light * x;
      m.y += light * y;
    }
  return {m.light, m.x / m.light, m.y / m.light};
}

std::vector<ScenePoint> scattered(int count, int columns, int rows, double margin) {
  std::vector<ScenePoint> points;
  const RngKey key = rng_key(1, "test", 1, "points");
  for (std::uint32_t i = 0; i < std::uint32_t(count); ++i) {
    const auto u = [&](std::uint32_t draw) { return uniform_of(rng_word(key, i, draw)); };
    points.push_back({-margin + u(0) * (columns + 2 * margin), -margin + u(1) * (rows + 2 * margin),
                      std::pow(10.0, 1 + 4 * u(2))});
  }
  return points;
}

// Reference: the closed form, the Gaussian's error function over each cell. The centroid is that of
// the cells' light, which integration over cells moves off the place of a narrow point.
TEST(Scene, APointHasItsLightAndItsPlaceInEveryCell) {
  for (const double sigma : {0.02, 0.1, 0.3, 0.64, 1.0, 1.9, 2.0, 5.0, 40.0})
    for (const double phase : {0.0, 0.123, 0.5, 0.87}) {
      const double x = 300 + phase, y = 290 + 0.7 * phase;
      const ExpectedElectronImage image = drawn({{x, y, 1e4}}, sigma, 600, 600);
      const Moments m = moments(image);
      EXPECT_NEAR(m.light / 1e4, 1.0, 3e-6) << sigma << " " << phase;
      double worst = 0, peak = 0, exact_x = 0, exact_y = 0;
      const auto share = [&](double d) {
        const double s = std::sqrt(0.5) / sigma;
        return 0.5 * (std::erf((d + 0.5) * s) - std::erf((d - 0.5) * s));
      };
      for (int row = 0; row < image.rows; ++row)
        for (int column = 0; column < image.columns; ++column) {
          const double exact = 1e4 * share(column - x) * share(row - y);
          exact_x += exact / 1e4 * column;
          exact_y += exact / 1e4 * row;
          peak = std::max(peak, exact);
          worst = std::max(worst, std::abs(image.at(column, row) - exact));
        }
      EXPECT_LT(worst / peak, 4e-6) << sigma << " " << phase;  // what lies beyond 5 sigma
      EXPECT_NEAR(m.x, exact_x, 2e-5 * std::max(1.0, sigma)) << sigma << " " << phase;
      EXPECT_NEAR(m.y, exact_y, 2e-5 * std::max(1.0, sigma)) << sigma << " " << phase;
    }
}

// Across pieces, over the frame's edges and beside it.
TEST(Scene, ManyPointsAreWhatTheDepositMakesOfThem) {
  for (const double sigma : {0.1, 0.7, 3.0}) {
    const auto points = scattered(20000, 1300, 700, 30);
    const ExpectedElectronImage a = deposited(points, sigma, 1300, 700),
                                b = drawn(points, sigma, 1300, 700);
    double worst = 0, sum_a = 0, sum_b = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
      worst = std::max(worst, std::abs(double(a.pixels[i]) - b.pixels[i]));
      sum_a += a.pixels[i];
      sum_b += b.pixels[i];
    }
    const double peak = *std::max_element(a.pixels.begin(), a.pixels.end());
    EXPECT_LT(worst / peak, 2e-6) << sigma;
    EXPECT_NEAR(sum_b / sum_a, 1.0, 1e-6) << sigma;
  }
}

TEST(Scene, TheSameCallGivesTheSameBytes) {
  const auto points = scattered(5000, 600, 600, 10);
  const ExpectedElectronImage once = drawn(points, 0.8, 600, 600);
  EXPECT_EQ(once.pixels, drawn(points, 0.8, 600, 600).pixels);
}

TEST(Scene, PointsAreAddedToWhatIsThere) {
  ExpectedElectronImage image(40, 30, 7.0f);
  const ScenePoint point{20, 15, 100};
  renderer().add_points({&point, 1}, 1.0, plane_of(image));
  EXPECT_FLOAT_EQ(image.at(0, 0), 7.0f);
  EXPECT_GT(image.at(20, 15), 20.0f);
  const ScenePoint far{1e14, -1e14, 100};
  const ExpectedElectronImage before = image;
  renderer().add_points({&far, 1}, 1.0, plane_of(image));
  EXPECT_EQ(image.pixels, before.pixels);
}

// With a slope, an edge that is followed down to pixels, and odd sizes.
TEST(Scene, TheSkyIsWhatTheAnalyticGridMakesOfIt) {
  const PixelFunction smooth = [](double x, double y) {
    return 200 + 50 * std::sin(x / 300) * std::cos(y / 200);
  };
  const PixelFunction edge = [](double x, double y) { return x + 0.3 * y > 200 ? 200.0 : 100.0; };
  Threads one;
  for (const PixelFunction& f : {smooth, edge})
    for (const auto& [columns, rows] :
         {std::pair{1, 1}, {1, 40}, {33, 32}, {503, 329}, {1200, 700}}) {
      ExpectedElectronImage analytic(columns, rows), image(columns, rows);
      fill_from_grid(columns, rows, f, 0.005, analytic.pixels.data(), one);
      renderer().add_patches(patches_of_grid(columns, rows, f, 0.005, one), plane_of(image));
      double worst = 0;
      for (std::size_t i = 0; i < image.pixels.size(); ++i)
        worst =
            std::max(worst, std::abs(double(image.pixels[i]) / double(analytic.pixels[i]) - 1.0));
      EXPECT_LT(worst, 2e-6) << columns << " x " << rows;
    }
}

/// The picture that this program draws as a process of its own: its digest, and what drew it.
struct Drawn {
  std::string digest, by;
};

Drawn drawn_with(const std::string& environment) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string output = test::command_output(environment + " " + program +
                                                  " --gtest_also_run_disabled_tests"
                                                  " --gtest_filter=Scene.DISABLED_TellsItsPicture")
                                 .second;
  const std::size_t at = output.find("picture "), end = output.find('\n', at);
  if (at == std::string::npos) return {"", output};
  return {output.substr(at + 8, 64), output.substr(at + 73, end - at - 73)};
}

TEST(Scene, DISABLED_TellsItsPicture) {
  ExpectedElectronImage image = drawn(scattered(20000, 1300, 700, 30), 0.7, 1300, 700);
  const PixelFunction sky = [](double x, double y) { return 200 + x * 0.1 + y * y * 1e-4; };
  Threads one;
  renderer().add_patches(patches_of_grid(1300, 700, sky, 0.005, one), plane_of(image));
  const std::string digest = sha256_hex(
      {reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size() * sizeof(float)});
  std::printf("picture %s %s\n", digest.c_str(), renderer().description().c_str());
}

TEST(Scene, BytesDoNotDependOnTheRasterisersThreads) {
  const Drawn one = drawn_with("DMISE_RENDERER=osmesa LP_NUM_THREADS=0");
  ASSERT_EQ(one.digest.size(), 64u) << one.by;
  for (const std::string threads : {"1", "2", "5"})
    EXPECT_EQ(drawn_with("DMISE_RENDERER=osmesa LP_NUM_THREADS=" + threads).digest, one.digest)
        << threads;
}

// Mesa's software device through EGL is the same rasteriser: the same picture. What a graphics card
// makes of it, this does not show.
TEST(Scene, EglWithoutASurfaceDrawsWhatOsmesaDraws) {
  const Drawn egl = drawn_with("DMISE_RENDERER=egl EGL_PLATFORM=surfaceless");
  if (egl.digest.empty())
    DMISE_SKIP() << "needs EGL (Debian: libegl1, libgl1-mesa-dri): " << egl.by;
  EXPECT_EQ(egl.by.find("EGL, "), 0u) << egl.by;
  if (egl.by.find("llvmpipe") == std::string::npos) return;  // a graphics card
  EXPECT_EQ(egl.digest, drawn_with("DMISE_RENDERER=osmesa").digest);
}

TEST(Scene, ARendererThatThereIsNotHasASuggestion) {
  const std::string said = drawn_with("DMISE_RENDERER=osmessa").by;
  EXPECT_NE(said.find("must be osmesa or egl, did you mean osmesa?, got osmessa"), said.npos)
      << said;
}

TEST(Scene, RefusesWhatItCannotDraw) {
  ExpectedElectronImage image(10, 10);
  const ScenePoint point{5, 5, 1};
  EXPECT_THROW(renderer().add_points({&point, 1}, 0.0, plane_of(image)), Error);
  EXPECT_THROW(renderer().add_points({&point, 1}, 1.0, {}), Error);
}

}  // namespace
}  // namespace dmise
