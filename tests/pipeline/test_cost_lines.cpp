// Lines of cost.jsonl: one for each of the first frames, and then for ever more frames each.
#include "sensors/frame/cost_lines.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/config/sensors/effect_list.h"

namespace dmise {
namespace {

FrameProducts frame(std::uint32_t number, double total_s, int level = -1) {
  FrameProducts products;
  products.report.sensor = "watch";
  products.report.frame = number;
  products.total_s = total_s;
  products.times[*all_effects()[0]] = 0.5 * total_s;
  if (level >= 0) products.plan.planned = {{.facts = all_effects()[0], .level = level}};
  return products;
}

double number_in(const std::string& line, const std::string& key, double otherwise) {
  const auto at = line.find("\"" + key + "\":");
  return at == std::string::npos ? otherwise
                                 : std::strtod(line.c_str() + at + key.size() + 3, nullptr);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != text.npos; at = end + 1)
    lines.push_back(text.substr(at, end - at));
  return lines;
}

TEST(CostLines, AreAFewThousandForTwoDaysOfFramesAndLoseNone) {
  constexpr std::uint32_t frames = 42 * 3600;
  CostLines costs;
  std::string text;
  for (std::uint32_t n = 1; n <= frames; ++n) {
    const std::string more = costs.add(frame(n, 1e-3 * (n % 7)), 10.0 + n % 3);
    if (n <= frames_with_own_cost) {
      EXPECT_EQ(lines_of(more).size(), 1u) << n;
    }
    text += more;
  }
  text += costs.take();
  EXPECT_EQ(costs.take(), "");
  const auto lines = lines_of(text);
  EXPECT_LT(lines.size(), 5000u);
  EXPECT_LT(text.size(), 1u << 20);
  double counted = 0.0, seconds = 0.0, of_effect = 0.0, wanted = 0.0, last = 0.0, memory = 0.0;
  for (const std::string& line : lines) {
    const double of_line = number_in(line, "frames", 1.0);
    counted += of_line;
    seconds += of_line * number_in(line, "total_s", 0.0);
    of_effect += of_line * number_in(line, std::string(all_effects()[0]->name), 0.0);
    memory = std::max(memory, number_in(line, "pss_mb", 0.0));
    EXPECT_EQ(number_in(line, "frame", 0.0), last + of_line);
    last += of_line;
  }
  for (std::uint32_t n = 1; n <= frames; ++n) wanted += 1e-3 * (n % 7);
  EXPECT_EQ(counted, frames);
  EXPECT_NEAR(seconds, wanted, 1e-6 * frames);  // as they are rounded
  EXPECT_NEAR(of_effect, 0.5 * wanted, 1e-6 * frames);
  EXPECT_EQ(memory, 12.0);
}

TEST(CostLines, AFrameWithAnotherPlanHasItsOwn) {
  CostLines costs;
  std::uint32_t n = frames_with_own_cost * 4;
  EXPECT_EQ(lines_of(costs.add(frame(++n, 1.0, 0), 1.0)).size(), 1u);
  EXPECT_EQ(costs.add(frame(++n, 1.0, 0), 1.0), "");
  EXPECT_EQ(costs.add(frame(++n, 3.0, 0), 1.0), "");
  const auto lines = lines_of(costs.add(frame(++n, 5.0, 1), 1.0));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(number_in(lines[0], "frame", 0.0), n - 1);
  EXPECT_EQ(number_in(lines[0], "frames", 1.0), 2.0);
  EXPECT_EQ(number_in(lines[0], "total_s", 0.0), 2.0);
  EXPECT_EQ(number_in(lines[1], "frame", 0.0), n);
  EXPECT_EQ(number_in(lines[1], "frames", 1.0), 1.0);
}

}  // namespace
}  // namespace dmise
