#include "bench/figure.h"

#include <cstdio>

#include "core/base/files/json.h"

namespace dmise {

void print_figure(const Figure& f, bool json) {
  const bool met = f.less_is_better ? f.value <= f.target : f.value >= f.target;
  if (!json) {
    std::printf("%-26s %10.3f %-6s", f.name.c_str(), f.value, f.unit.c_str());
    if (f.anchor_value > 0)
      std::printf("  %s: %.3f (ratio %.2f)", f.anchor.c_str(), f.anchor_value,
                  f.value / f.anchor_value);
    if (f.target > 0) std::printf("  %s %g", met ? "reaches" : "misses", f.target);
    std::printf("\n");
    std::fflush(stdout);
    return;
  }
  JsonWriter writer;
  writer.begin_object().field("name", f.name).field("value", f.value).field("unit", f.unit);
  const auto optional = [&](const char* key, bool there, double value) {
    writer.key(key);
    there ? writer.value(value) : writer.null();
  };
  writer.key("anchor");
  f.anchor.empty() ? writer.null() : writer.value(f.anchor);
  optional("anchor_value", f.anchor_value > 0, f.anchor_value);
  optional("ratio", f.anchor_value > 0, f.anchor_value > 0 ? f.value / f.anchor_value : 0);
  optional("target", f.target > 0, f.target);
  writer.key("met");
  f.target > 0 ? writer.value(met) : writer.null();
  writer.end_object();
  std::printf("%s\n", writer.text().c_str());
  std::fflush(stdout);
}

}  // namespace dmise
