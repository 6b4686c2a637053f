#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/config/yaml/section.h"

namespace dmise {

/// The keys of a scenario.
const Section& scenario_section();

/// A kind of YAML file that users write.
struct FileKind {
  std::string_view name;  // as in `dmise schema NAME`
  std::string_view what;
  const Section& (*section)();
  bool draws = false;  // its values may be distributions
};
std::span<const FileKind> file_kinds();

/// Sections that a section leads to, itself first, each once. Throws `std::logic_error` if two have
/// one name.
std::vector<const Section*> sections_within(const Section& section);

/// JSON Schema (draft 7) of a kind of file, made from the tables that its readers read by.
std::string json_schema(const FileKind& kind);

/// docs/reference/NAME.md. Sections that another kind of file documents are links to it.
std::string schema_markdown(const FileKind& kind);

}  // namespace dmise
