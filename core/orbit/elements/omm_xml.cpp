#include <algorithm>
#include <pugixml.hpp>

#include "core/base/files/text_fields.h"
#include "core/orbit/elements/omm.h"

namespace dmise {

namespace {

/// Line numbers of ascending offsets, in one pass over the text.
class LineCounter {
 public:
  explicit LineCounter(std::string_view text) : text_(text) {}
  int line_at(std::ptrdiff_t offset) {
    const std::size_t to =
        std::min(text_.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    if (to < counted_) return line_;
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                         text_.begin() + static_cast<std::ptrdiff_t>(to), '\n'));
    counted_ = to;
    return line_;
  }

 private:
  std::string_view text_;
  std::size_t counted_ = 0;
  int line_ = 1;
};

/// Every element with a text and without child elements is a field.
struct FieldCollector : pugi::xml_tree_walker {
  OmmFields omm;

  bool for_each(pugi::xml_node& node) override {
    if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata)
      omm.set(node.parent().name(), node.value(), node.parent().attribute("units").value());
    return true;
  }
};

}  // namespace

void read_omm_xml(std::string_view text, CatalogueFile& file) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  LineCounter lines(text);
  if (!result)
    throw ConfigError(at_line(file.source, lines.line_at(result.offset),
                              std::string("invalid XML: ") + result.description()));

  // Iterative, because the depth is up to the input.
  pugi::xml_node node = document.first_child();
  while (node) {
    const bool is_message = std::string_view(node.name()) == "omm";
    if (is_message) {
      FieldCollector collector;
      node.traverse(collector);
      add_omm(collector.omm, lines.line_at(node.offset_debug()), file);
    }
    if (!is_message && node.first_child()) {
      node = node.first_child();
      continue;
    }
    while (node && !node.next_sibling()) node = node.parent();
    if (node) node = node.next_sibling();
  }
}

}  // namespace dmise
