#include "sensors/indi/indi_stream.h"

#include <pugixml.hpp>

#include "core/base/printable.h"

namespace dmise {
namespace {

constexpr int max_depth = 2;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string without_outer_space(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return std::string(text);
}

IndiElement element_of(const pugi::xml_node& node) {
  IndiElement element{.name = node.name(), .attributes = {}, .text = {}, .parts = {}};
  for (const pugi::xml_attribute& attribute : node.attributes())
    element.attributes[attribute.name()] = attribute.value();
  element.text = without_outer_space(node.text().get());
  for (const pugi::xml_node& part : node.children())
    if (part.type() == pugi::node_element) element.parts.push_back(element_of(part));
  return element;
}

/// An instruction is no element.
std::optional<IndiElement> parse_element(std::string_view bytes) {
  if (!is_utf8(bytes)) throw BadIndi("the text is not UTF-8");
  pugi::xml_document document;
  const auto result = document.load_buffer(
      bytes.data(), bytes.size(), pugi::parse_default | pugi::parse_fragment, pugi::encoding_utf8);
  if (!result) throw BadIndi(std::string("invalid XML: ") + result.description());
  const pugi::xml_node node = document.first_child();
  return node ? std::optional(element_of(node)) : std::nullopt;
}

}  // namespace

std::string IndiElement::attribute(const std::string& key) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? "" : found->second;
}

bool IndiStream::ends_tag() {
  in_ = In::between;
  if (closing_)
    --depth_;
  else if (last_ != '/')
    ++depth_;
  if (depth_ < 0) throw BadIndi("an element ends that has not begun");
  if (depth_ > max_depth || (depth_ == max_depth && last_ == '/' && !closing_))
    throw BadIndi("elements within elements within elements");
  return depth_ == 0;
}

bool IndiStream::ends_with(char c) {
  switch (in_) {
    case In::between:
      if (c == '<') in_ = In::tag_begin;
      if (c != '<' && depth_ == 0 && !is_space(c)) throw BadIndi("text between elements");
      return false;
    case In::tag_begin:
      if (c == '!') throw BadIndi("declarations, comments and CDATA are refused");
      if (c == '?' && depth_ > 0) throw BadIndi("an instruction in an element");
      if (c == '>' || c == '<') throw BadIndi("a tag without a name");
      closing_ = c == '/';
      in_ = c == '?' ? In::instruction : In::tag;
      last_ = 0;
      return false;
    case In::instruction:
      if (c == '>') in_ = In::between;
      return c == '>';
    case In::tag:
      break;
  }
  if (quote_ != 0) {
    if (c == quote_) quote_ = 0;
    last_ = 0;
    return false;
  }
  if (c == '>') return ends_tag();
  if (c == '<') throw BadIndi("a tag in a tag");
  if (c == '"' || c == '\'') quote_ = c;
  last_ = c;
  return false;
}

std::optional<IndiElement> IndiStream::next() {
  while (looked_at_ < waiting_.size()) {
    if (looked_at_ >= max_indi_element_bytes)
      throw BadIndi("an element of more than " + std::to_string(max_indi_element_bytes) + " bytes");
    if (!ends_with(waiting_[looked_at_++])) continue;
    const std::string bytes = waiting_.substr(0, looked_at_);
    waiting_.erase(0, looked_at_);
    looked_at_ = 0;
    if (auto element = parse_element(bytes)) return element;
  }
  if (in_ == In::between && depth_ == 0) {  // white space
    waiting_.clear();
    looked_at_ = 0;
  }
  return std::nullopt;
}

}  // namespace dmise
