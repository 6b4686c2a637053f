#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dmise {

/// What the header of another camera's frame may leave unsaid.
enum class FrameFact : std::uint32_t {
  time = 1,
  exposure = 2,
  site = 4,
  pointing = 8,
  focal_length = 16,
  zero_point = 32,
  extinction = 64,
  band = 128,
  bias = 256,
  gain = 512,  // electrons are then counts
};

struct FrameFactName {
  FrameFact fact;
  const char* name;  // all of them, with blanks between, fit into a FITS card
};
inline constexpr FrameFactName frame_fact_names[] = {
    {FrameFact::time, "time"},          {FrameFact::exposure, "exposure"},
    {FrameFact::site, "site"},          {FrameFact::pointing, "pointing"},
    {FrameFact::focal_length, "focal"}, {FrameFact::zero_point, "zero"},
    {FrameFact::extinction, "extinct"}, {FrameFact::band, "band"},
    {FrameFact::bias, "bias"},          {FrameFact::gain, "gain"}};

/// The facts of a frame that are not known. The header then holds a stand-in for each, and what
/// follows from it is null in products.
struct UnknownFacts {
  std::uint32_t bits = 0;  // a sum of `FrameFact`

  bool has(FrameFact fact) const { return (bits & std::uint32_t(fact)) != 0; }
  bool any() const { return bits != 0; }
  void add(FrameFact fact) { bits |= std::uint32_t(fact); }
  void remove(FrameFact fact) { bits &= ~std::uint32_t(fact); }
  bool operator==(const UnknownFacts&) const = default;

  /// Names with blanks between.
  std::string text() const {
    std::string out;
    for (const auto& [fact, name] : frame_fact_names)
      if (has(fact)) out += (out.empty() ? "" : " ") + std::string(name);
    return out;
  }
  /// The inverse; empty if a word is no name of a fact.
  static std::optional<UnknownFacts> of_text(std::string_view text) {
    UnknownFacts facts;
    while (!text.empty()) {
      const std::string_view word = text.substr(0, text.find(' '));
      text.remove_prefix(word.size() + (word.size() < text.size()));
      bool named = word.empty();
      for (const auto& [fact, name] : frame_fact_names)
        if (word == name) {
          facts.add(fact);
          named = true;
        }
      if (!named) return std::nullopt;
    }
    return facts;
  }
};

}  // namespace dmise
