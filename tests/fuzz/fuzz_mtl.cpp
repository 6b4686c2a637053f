#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/materials/mtl_file.h"

using namespace dmise;

// Every material that is read conserves energy. Everything else is a ConfigError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> notes;
  const auto library = [](std::string_view name) {
    return name == "kapton" ? std::optional<Material>(Material{}) : std::nullopt;
  };
  try {
    for (const auto& [name, material] : parse_mtl(text, "fuzz", library, notes))
      check_material(material);
  } catch (const ConfigError&) {
  }
  return 0;
}
