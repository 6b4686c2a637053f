#pragma once
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/base/pixel.h"
#include "core/base/simd_level.h"
#include "core/optics/psf_table.h"

// Light of point sources and of moving ones, put on the pixels analytically: the path integral of
// the pixel-integrated Gaussian over the exposure. No grid, so no ringing and nothing lost.
namespace dmise {

/// Light that one source leaves while it moves for a part of the exposure: the parabola in time
/// through three places, straight and even when `middle` is half way, a point when all are equal.
/// Brightness changes linearly over the time, from mean (1 - tilt) to mean (1 + tilt).
struct Arc {
  PixelPosition start, middle, end;  // anywhere, also outside the frame
  double signal_e = 0.0;             // of the whole arc, expected [e-], >= 0
  double tilt = 0.0;                 // [-1, 1]

  bool is_point() const {
    const auto is_middle = [this](PixelPosition p) {
      return p.x_px == middle.x_px && p.y_px == middle.y_px;
    };
    return is_middle(start) && is_middle(end);
  }
};

/// What fell inside the frame: the signal and the mean of the pixel centres weighted by it. Where
/// `signal_e` is 0 the place is (0, 0).
struct Deposited {
  double signal_e = 0.0;
  double x_px = 0.0, y_px = 0.0;
};

/// Both together, as one source.
Deposited operator+(const Deposited& a, const Deposited& b);

/// Where light is put: `rows` rows of `columns` floats, `stride` apart. What is told of an arc is
/// what falls on the part that starts at (left, top), in coordinates of the view.
struct DepositView {
  float* pixels = nullptr;
  int columns = 0, rows = 0;
  std::ptrdiff_t stride = 0;
  int left = 0, top = 0, told_columns = 0, told_rows = 0;
};

/// Adds arcs to `image` [e-] and tells what of each fell inside. Light per pixel is right to 2e-6
/// of the arc's brightest pixel, the sum over pixels to 1e-6, whatever the length (0 to 1e12 px):
/// along the path, panels of 2 sigma with five Gauss-Legendre nodes. The bytes do not depend on the
/// number of threads or the instruction set. Throws `Error` naming the arc when a number of it is
/// not finite or the signal is negative.
std::vector<Deposited> deposit(std::span<const Arc> arcs, const PsfTable& psf,
                               ExpectedElectronImage& image, Threads& threads,
                               SimdLevel level = best_simd_level());

std::vector<Deposited> deposit(std::span<const Arc> arcs, const PsfTable& psf,
                               const DepositView& view, Threads& threads,
                               SimdLevel level = best_simd_level());

/// What of an arc falls on the told part of a view, whose pixels are not touched.
Deposited told(const Arc& arc, const PsfTable& psf, const DepositView& view);

/// The part of an arc between two of its times, 0..1.
Arc part_of(const Arc& arc, double tau_begin, double tau_end);

/// Rectangle that holds the arc's path [px].
struct Extent {
  double left, top, right, bottom;
};
Extent extent(const Arc& arc);

/// Cuts a source's arc into one a step of `brightness`: its values, relative, at equally spaced
/// times from start to end (at least 2, each >= 0), linear in between. The arcs' signals sum to
/// `whole.signal_e` times the mean brightness; the tilt of `whole` is not used.
std::vector<Arc> with_brightness(const Arc& whole, std::span<const double> brightness);

/// Place on the arc at `tau` of its time, 0 at the start, 1 at the end.
PixelPosition place(const Arc& arc, double tau);

}  // namespace dmise
