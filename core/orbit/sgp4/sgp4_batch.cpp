#include "core/orbit/sgp4/sgp4_batch.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/orbit/elements/epoch.h"
#include "core/orbit/sgp4/sgp4_groups.h"
#include "core/orbit/sgp4/sgp4_kernels.h"

namespace dmise {

using namespace sgp4;

namespace {

constexpr std::size_t tile_states = 4096;  // 57 bytes of output each
constexpr std::size_t tile_of_thread = 1024;

void check_sizes(std::size_t n, std::span<const double> position, std::span<const double> velocity,
                 std::span<const std::uint8_t> code) {
  if (position.size() != 3 * n || velocity.size() != 3 * n || code.size() != n)
    throw Error("SGP4 output of " + std::to_string(n) + " states: output has space for " +
                std::to_string(position.size()) + " position, " + std::to_string(velocity.size()) +
                " velocity components and " + std::to_string(code.size()) + " codes");
}

void put_failure(const Output& out, std::size_t i, std::uint8_t code) {
  out.code[i] = code;
  for (std::size_t axis = 0; axis < 3; ++axis)
    out.position[i + axis * out.stride] = out.velocity[i + axis * out.stride] = 0.0;
}

}  // namespace

struct Sgp4Batch::State {
  /// Lane number within a group, or the code of an object without a model.
  struct Place {
    std::uint8_t group = 0, code = 0;
    std::uint32_t slot = 0;
  };
  const Kernels* kernels = nullptr;
  std::vector<Group> groups{group_count};
  std::vector<Place> places;
  std::vector<std::uint32_t> failed;

  void add(const Model& m) {
    const auto object = static_cast<std::uint32_t>(places.size());
    Place place{.code = m.code};
    if (m.code != 0) {
      failed.push_back(object);
    } else {
      place.group = static_cast<std::uint8_t>(group_of(m));
      Group& g = groups[place.group];
      place.slot = static_cast<std::uint32_t>(g.index.size());
      g.add(m, object);
    }
    places.push_back(place);
  }

  const SecularTerms<Lanes>& secular(const Place& p) const {
    const Group& g = groups[p.group];
    return g.deep ? g.far[p.slot / block_lanes].secular : g.near[p.slot / block_lanes].secular;
  }

  double minutes(const Place& p, const ElapsedDate& time) const {
    const SecularTerms<Lanes>& s = secular(p);
    const int lane = static_cast<int>(p.slot % block_lanes);
    return (time.jd1 - s.epoch_jd1.lane[lane]) * minutes_per_day +
           (time.jd2 - s.epoch_jd2.lane[lane]) * minutes_per_day;
  }

  /// Works on one tile of the output after the other, so that it stays in the cache.
  void run_all(const Instants& times, const Output& out, Threads* threads) const {
    const std::size_t tile = std::max<std::size_t>(tile_states / times.count, block_lanes);
    const auto work = [&](std::size_t begin, std::size_t end) {
      for (const Group& g : groups)
        g.run(*kernels, g.first_block_from(begin), g.first_block_from(end), times, out);
    };
    if (threads && threads->count() > 1) {
      threads->for_ranges(places.size(), std::min(tile, tile_of_thread), work);
      return;
    }
    for (std::size_t begin = 0; begin < places.size(); begin += tile)
      work(begin, std::min(begin + tile, places.size()));
  }

  /// Eight lanes gathered from anywhere in one group.
  struct Gathered {
    NearTerms<Lanes> near;
    DeepTerms<Lanes> far;
    SynchronousTerms<Lanes> day;
    HalfDayTerms<Lanes> half_day;
    ResonanceNode node = no_node();
    Lanes t;
    BlockStates states;

    void copy(const Group& g, std::uint32_t slot, int lane) {
      const std::size_t k = slot / block_lanes;
      const int from = static_cast<int>(slot % block_lanes);
      if (!g.deep) copy_lane(near, lane, g.near[k], from);
      if (g.deep) copy_lane(far, lane, g.far[k], from);
      if (g.resonance == Resonance::day) copy_lane(day, lane, g.day[k], from);
      if (g.resonance == Resonance::half_day) copy_lane(half_day, lane, g.half_day[k], from);
    }
    void propagate(const Group& g, const Kernels& kernels) {
      if (!g.deep) {
        kernels.near_block(near, g.shape, t, states);
      } else {
        kernels.deep_block(
            {&far, g.resonance == Resonance::day ? &day : nullptr,
             g.resonance == Resonance::half_day ? &half_day : nullptr, &node, g.shape},
            t, states);
      }
    }
    void put(int lane, const Output& out, std::size_t i) const {
      out.code[i] = states.code[lane];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        out.position[i + axis * out.stride] = states.position[axis][lane];
        out.velocity[i + axis * out.stride] = states.velocity[axis][lane];
      }
    }
  };
};

std::string_view describe(Sgp4Code code) {
  switch (code) {
    case Sgp4Code::ok:
      return "ok";
    case Sgp4Code::eccentricity:
      return "mean eccentricity outside [0, 1)";
    case Sgp4Code::mean_motion:
      return "mean motion not above 0";
    case Sgp4Code::perturbed_eccentricity:
      return "perturbed eccentricity outside [0, 1]";
    case Sgp4Code::semilatus_rectum:
      return "semilatus rectum below 0";
    case Sgp4Code::decayed:
      return "decayed: below the Earth's surface";
    case Sgp4Code::absurd:
      return "radius beyond 2.2 a (1 + e), or too far from its epoch";
  }
  return "unknown code";
}

Sgp4Batch::Sgp4Batch(SimdLevel simd) : state_(std::make_unique<State>()) {
  state_->kernels =
      kernel_of(simd, &sse2::sgp4_kernels, &avx2::sgp4_kernels, &avx512::sgp4_kernels);
}

Sgp4Batch::Sgp4Batch(std::span<const MeanElements> elements, Threads* threads, SimdLevel simd)
    : Sgp4Batch(simd) {
  append(elements, threads);
}

void Sgp4Batch::append(std::span<const MeanElements> elements, Threads* threads) {
  // In pieces, to limit the memory for the models of a large catalogue.
  constexpr std::size_t piece = 4096;
  std::vector<Model> models(std::min(piece, elements.size()));
  for (std::size_t start = 0; start < elements.size(); start += piece) {
    const std::size_t count = std::min(piece, elements.size() - start);
    const auto work = [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) models[k] = initialise(elements[start + k]);
    };
    if (threads)
      threads->for_ranges(count, 256, work);
    else
      work(0, count);
    for (std::size_t k = 0; k < count; ++k) state_->add(models[k]);
  }
  for (Group& g : state_->groups) g.make_nodes();
}

Sgp4Batch::~Sgp4Batch() = default;

std::size_t Sgp4Batch::size() const { return state_->places.size(); }

void Sgp4Batch::propagate(double jd1, double jd2, std::span<double> position_m,
                          std::span<double> velocity_m_per_s, std::span<std::uint8_t> code,
                          Threads* threads) const {
  const Utc time{jd1, jd2};
  propagate({&time, 1}, position_m, velocity_m_per_s, code, threads);
}

void Sgp4Batch::propagate(std::span<const Utc> times, std::span<double> position_m,
                          std::span<double> velocity_m_per_s, std::span<std::uint8_t> code,
                          Threads* threads) const {
  const std::size_t n = size();
  check_sizes(times.size() * n, position_m, velocity_m_per_s, code);
  // A few at once: enough to reuse the terms from the L1 cache, few enough output streams.
  constexpr std::size_t times_at_once = 8;
  for (std::size_t start = 0; start < times.size(); start += times_at_once) {
    const std::size_t count = std::min(times_at_once, times.size() - start);
    Instant instants[times_at_once];
    for (std::size_t k = 0; k < count; ++k) {
      const ElapsedDate time = elapsed_date(times[start + k]);
      instants[k] = {time.jd1, time.jd2};
    }
    const Output out{position_m.data() + 3 * n * start, velocity_m_per_s.data() + 3 * n * start,
                     code.data() + n * start, n};
    std::fill_n(out.code, n * count, std::uint8_t{0});
    state_->run_all({instants, count}, out, threads);
    for (std::size_t k = 0; k < count; ++k)
      for (std::uint32_t i : state_->failed)
        put_failure({out.position + 3 * n * k, out.velocity + 3 * n * k, out.code + n * k, n}, i,
                    state_->places[i].code);
  }
}

void Sgp4Batch::propagate_some(std::span<const std::uint32_t> objects, double jd1, double jd2,
                               std::span<double> position_m, std::span<double> velocity_m_per_s,
                               std::span<std::uint8_t> code) const {
  check_sizes(objects.size(), position_m, velocity_m_per_s, code);
  const Output out{position_m.data(), velocity_m_per_s.data(), code.data(), objects.size()};
  const ElapsedDate time = elapsed_date({jd1, jd2});
  for (std::size_t k = 0; k < objects.size(); ++k) {
    if (objects[k] >= size())
      throw Error("SGP4: object " + std::to_string(objects[k]) + " of " + std::to_string(size()));
    const State::Place& p = state_->places[objects[k]];
    if (p.code != 0) put_failure(out, k, p.code);
  }
  for (std::size_t group = 0; group < group_count; ++group) {
    const Group& g = state_->groups[group];
    State::Gathered some;
    std::size_t to[block_lanes];
    int lanes = 0;
    const auto flush = [&] {
      if (lanes == 0) return;
      for (int k = lanes; k < block_lanes; ++k) {
        const State::Place& p = state_->places[objects[to[0]]];
        some.copy(g, p.slot, k);
        some.t.lane[k] = some.t.lane[0];
      }
      some.node = no_node();
      some.propagate(g, *state_->kernels);
      for (int k = 0; k < lanes; ++k) some.put(k, out, to[k]);
      lanes = 0;
    };
    if (g.index.empty()) continue;
    for (std::size_t k = 0; k < objects.size(); ++k) {
      const State::Place& p = state_->places[objects[k]];
      if (p.code != 0 || p.group != group) continue;
      some.copy(g, p.slot, lanes);
      some.t.lane[lanes] = state_->minutes(p, time);
      to[lanes++] = k;
      if (lanes == block_lanes) flush();
    }
    flush();
  }
}

void Sgp4Batch::propagate_times(std::size_t object, std::span<const double> minutes,
                                std::span<double> position_m, std::span<double> velocity_m_per_s,
                                std::span<std::uint8_t> code) const {
  check_sizes(minutes.size(), position_m, velocity_m_per_s, code);
  const Output out{position_m.data(), velocity_m_per_s.data(), code.data(), minutes.size()};
  const State::Place& p = state_->places.at(object);
  if (p.code != 0) {
    for (std::size_t k = 0; k < minutes.size(); ++k) put_failure(out, k, p.code);
    return;
  }
  const Group& g = state_->groups[p.group];
  State::Gathered all;
  for (int lane = 0; lane < block_lanes; ++lane) all.copy(g, p.slot, lane);
  for (std::size_t start = 0; start < minutes.size(); start += block_lanes) {
    const std::size_t count = std::min<std::size_t>(block_lanes, minutes.size() - start);
    for (std::size_t k = 0; k < block_lanes; ++k)
      all.t.lane[k] = minutes[start + std::min(k, count - 1)];
    all.propagate(g, *state_->kernels);
    for (std::size_t k = 0; k < count; ++k) all.put(static_cast<int>(k), out, start + k);
  }
}

Sgp4State Sgp4Batch::propagate_one(std::size_t object, double minutes_since_epoch) const {
  double r[3], v[3];
  std::uint8_t code;
  propagate_times(object, {&minutes_since_epoch, 1}, r, v, {&code, 1});
  return {{r[0], r[1], r[2]}, {v[0], v[1], v[2]}, static_cast<Sgp4Code>(code)};
}

double Sgp4Batch::minutes_since_epoch(std::size_t object, double jd1, double jd2) const {
  const State::Place& p = state_->places.at(object);
  if (p.code != 0)
    throw Error("SGP4: object " + std::to_string(object) +
                " has no epoch: " + std::string(describe(static_cast<Sgp4Code>(p.code))));
  return state_->minutes(p, elapsed_date({jd1, jd2}));
}

}  // namespace dmise
