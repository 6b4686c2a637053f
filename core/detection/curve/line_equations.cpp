#include "core/detection/curve/line_equations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double shortest_fwhms = 1.75;  // shortest wave: the PSF leaves 0.3 of it
constexpr double max_cycles = 160.0;  // the shortest wave has so many on the line: bounds the time

}  // namespace

LineEquations::Column LineEquations::column(std::vector<double> shape, double background) const {
  Column out{.shape = {}, .background = background, .product = light_.matrix.times(shape)};
  out.background_product = background * light_.background_weight;
  out.right = background * light_.background_right;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    out.product[i] += background * light_.background[i];
    out.background_product += light_.background[i] * shape[i];
    out.right += light_.right[i] * shape[i];
  }
  out.shape = std::move(shape);
  return out;
}

LineEquations::Column LineEquations::free_piece(std::size_t piece) const {
  std::vector<double> shape(light_.all_pieces(), 0.0);
  shape[piece] = 1.0;
  return column(std::move(shape));
}

template <class Function>
LineEquations::Column LineEquations::along_line(const Function& of) const {
  std::vector<double> shape(light_.all_pieces(), 0.0);
  for (std::size_t i = free_pieces; i + free_pieces < shape.size(); ++i)
    shape[i] = of(light_.along_px(i));
  return column(std::move(shape));
}

double LineEquations::product_of(const Column& a, const Column& b) {
  double sum = a.background * b.background_product;
  for (std::size_t i = 0; i < a.shape.size(); ++i) sum += a.shape[i] * b.product[i];
  return sum;
}

LineEquations::LineEquations(const StreakLight& light) : light_(light), factor_(others, others) {
  for (std::size_t i = 0; i < free_pieces; ++i) {
    others_.push_back(free_piece(i));
    others_.push_back(free_piece(light.all_pieces() - 1 - i));
  }
  others_.push_back(column(std::vector<double>(light.all_pieces(), 0.0), 1.0));
  others_.push_back(along_line([](double) { return 1.0; }));
  others_.push_back(along_line([&](double px) { return 2 * px / light.length_px; }));
  for (std::size_t i = 0; i < others; ++i)
    for (std::size_t j = 0; j <= i; ++j) factor_.at(i, j) = product_of(others_[i], others_[j]);
  solvable_ = factor_.factorise();
  for (const Column& other : others_) value_.push_back(other.right);
  if (solvable_) value_ = factor_.solve(std::move(value_));
}

double LineEquations::even_variance_e2() const {
  std::vector<double> one(others, 0.0);
  one[even_light] = 1.0;
  return factor_.solve(std::move(one))[even_light];
}

double LineEquations::highest_frequency() const {
  return std::min(1 / (shortest_fwhms * light_.fwhm_px), max_cycles / light_.length_px);
}

std::size_t LineEquations::harmonics_at(double frequency, std::size_t most) const {
  return std::min(most, std::size_t(highest_frequency() / frequency));
}

LightEquations LineEquations::beside_others(const std::vector<Column>& columns) const {
  LightEquations out{
      .matrix = BandedMatrix(columns.size(), columns.size()), .right = {}, .even_e = {}};
  std::vector<std::vector<double>> stands_for;  // light of the others that each column stands for
  for (std::size_t i = 0; i < columns.size(); ++i) {
    std::vector<double> by_others;
    for (const Column& other : others_) by_others.push_back(product_of(other, columns[i]));
    double right = columns[i].right;
    for (std::size_t k = 0; k < others; ++k) right -= by_others[k] * value_[k];
    out.right.push_back(right);
    stands_for.push_back(factor_.solve(by_others));
    out.even_e.push_back(stands_for[i][even_light]);
    for (std::size_t j = 0; j <= i; ++j) {
      double product = product_of(columns[j], columns[i]);
      for (std::size_t k = 0; k < others; ++k) product -= stands_for[j][k] * by_others[k];
      out.matrix.at(i, j) = product;
    }
  }
  return out;
}

LightEquations LineEquations::harmonics(double frequency, std::size_t most, double as_at) const {
  const std::size_t count = harmonics_at(as_at, most);
  std::vector<Column> waves;
  for (std::size_t h = 1; h <= count; ++h) {
    // Steps from piece to piece: the amplitude of a wave through them is less by a sinc.
    const double turn = 2 * pi * frequency * double(h), half = turn * light_.piece_px / 2;
    const double height = half / std::sin(half);
    waves.push_back(along_line([&](double px) { return height * std::cos(turn * px); }));
    waves.push_back(along_line([&](double px) { return height * std::sin(turn * px); }));
  }
  LightEquations out = beside_others(waves);
  out.harmonics_shown = highest_frequency() / as_at;
  return out;
}

LightEquations LineEquations::bins() const {
  std::vector<Column> columns;
  for (std::size_t i = free_pieces; i + free_pieces + pieces_of_bin <= light_.all_pieces();
       i += pieces_of_bin) {
    std::vector<double> shape(light_.all_pieces(), 0.0);
    for (std::size_t k = 0; k < pieces_of_bin; ++k) shape[i + k] = 1.0;
    columns.push_back(column(std::move(shape)));
  }
  return beside_others(columns);
}

}  // namespace dmise
