#include "core/config/yaml/section.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace dmise {

const Key* Section::find(std::string_view key) const {
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == key; });
  return found != keys.end() ? &*found : any_other ? &*any_other : nullptr;
}

Forms operator|(Forms a, const Forms& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

namespace form {

using Kind = Form::Kind;

Forms number(double least, double most) {
  return {{.kind = Kind::number, .bounds = Bounds::between(least, most)}};
}
Forms above(double least, double most) {
  return {{.kind = Kind::number, .bounds = Bounds::above(least, most)}};
}
Forms positive() { return {{.kind = Kind::number, .bounds = Bounds::positive()}}; }
Forms not_negative() { return {{.kind = Kind::number, .bounds = {.least = 0.0}}}; }
Forms integer(std::int64_t least, std::int64_t most) {
  return {{.kind = Kind::integer, .least = least, .most = most}};
}
Forms seed() { return integer(0, std::numeric_limits<std::int64_t>::max()); }
Forms text(std::vector<std::string> suggested) {
  return {{.kind = Kind::text, .words = std::move(suggested)}};
}
Forms time() { return {{.kind = Kind::time}}; }
Forms flag() { return {{.kind = Kind::flag}}; }
Forms choice(std::vector<std::string> words) {
  return {{.kind = Kind::choice, .words = std::move(words)}};
}
Forms list(Forms items, std::size_t fewest) {
  return {{.kind = Kind::list, .fewest = fewest, .items = std::move(items)}};
}
Forms numbers(std::size_t count, double least, double most) {
  return {{.kind = Kind::list, .fewest = count, .greatest = count, .items = number(least, most)}};
}
Forms positive_numbers(std::size_t count, double most) {
  return {{.kind = Kind::list, .fewest = count, .greatest = count, .items = above(0.0, most)}};
}
Forms map(const Section& (*section)()) { return {{.kind = Kind::map, .section = section}}; }

}  // namespace form

std::string sentence_of(std::string_view comment) {
  std::string unit;
  if (comment.starts_with('[')) {
    const std::size_t end = comment.find(']');
    unit = " " + std::string(comment.substr(0, end + 1));
    comment.remove_prefix(std::min(comment.size(), end + 2));
  }
  if (comment.empty()) return "In" + unit + ".";
  std::string text(comment);
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = char(text[0] - 'a' + 'A');
  return text + unit + ".";
}

Key required(std::string name, Forms forms, std::string what) {
  return {std::move(name), std::move(forms), std::move(what), {}, true};
}
Key optional(std::string name, Forms forms, std::string what, std::string otherwise) {
  return {std::move(name), std::move(forms), std::move(what), std::move(otherwise), false};
}

Key later(Key key) {
  key.binding.later = true;
  return key;
}

std::vector<Key> with_keys(std::vector<Key> keys, std::vector<Key> shared) {
  std::ranges::move(shared, std::back_inserter(keys));
  return keys;
}

}  // namespace dmise
