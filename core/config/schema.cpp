#include "core/config/schema.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/files/json.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/config/objects/material_config.h"
#include "core/config/sensors/camera_config.h"
#include "core/config/sensors/sensor_config.h"

namespace dmise {
namespace {

using Kind = Form::Kind;

constexpr FileKind kinds[] = {
    {"scenario", "a scenario: when, what is in space, who watches it", scenario_section},
    {"dataset", "a scenario for `dmise dataset`, whose values may be drawn", scenario_section,
     true},
    {"camera", "a camera: optics, detector, band", camera_section},
    {"site", "a place on the ground", site_section},
    {"materials", "materials of surfaces", material_library_section}};

void find_within(const Section& section, std::vector<const Section*>& found);

void find_within(const Forms& forms, std::vector<const Section*>& found) {
  for (const Form& form : forms) {
    if (form.kind == Kind::map) find_within(form.section(), found);
    find_within(form.items, found);
  }
}

void find_within(const Section& section, std::vector<const Section*>& found) {
  for (const Section* known : found) {
    if (known == &section) return;
    if (known->name == section.name)
      throw std::logic_error("core/config: two sections are named " + section.name);
  }
  found.push_back(&section);
  for (const Key& key : section.keys) find_within(key.forms, found);
  if (section.any_other) find_within(section.any_other->forms, found);
}

bool is_number(const std::string& text) { return parse_real(text).has_value(); }

bool has(const Forms& forms, Kind kind) {
  return std::any_of(forms.begin(), forms.end(), [&](const Form& f) { return f.kind == kind; });
}

bool has_choice(const Forms& forms, const std::string& word) {
  return std::any_of(forms.begin(), forms.end(), [&](const Form& f) {
    return f.kind == Kind::choice && std::ranges::find(f.words, word) != f.words.end();
  });
}

/// Writes JSON Schema. Values of a file that draws may be distributions as well.
class SchemaWriter {
 public:
  explicit SchemaWriter(const FileKind& kind) : kind_(kind) {}

  std::string text() {
    json_.begin_object();
    json_.field("$schema", "http://json-schema.org/draft-07/schema#");
    json_.field("title", "DMISE " + std::string(kind_.name));
    members(kind_.section());
    json_.key("definitions").begin_object();
    for (const Section* section : sections_within(kind_.section())) {
      json_.key(section->name).begin_object();
      members(*section);
      json_.end_object();
    }
    if (kind_.draws) distribution();
    return json_.end_object().end_object().take();
  }

 private:
  void members(const Section& section) {
    json_.field("description", section.what).field("type", "object");
    json_.key("properties").begin_object();
    for (const Key& key : section.keys) property(key);
    json_.end_object();
    if (section.any_other) {
      json_.key("patternProperties").begin_object();
      property(*section.any_other);
      json_.end_object();
    }
    json_.field("additionalProperties", false).key("required").begin_array();
    for (const Key& key : section.keys)
      if (key.required) json_.value(key.name);
    json_.end_array();
  }

  void property(const Key& key) {
    json_.key(key.name).begin_object();
    json_.field("description",
                key.what + (key.otherwise.empty() ? "" : " Default: " + key.otherwise + "."));
    if (has(key.forms, Kind::flag) && (key.otherwise == "on" || key.otherwise == "off")) {
      json_.field("default", key.otherwise == "on");
    } else if (is_number(key.otherwise)) {
      json_.key("default").raw(key.otherwise);
    } else if (has_choice(key.forms, key.otherwise)) {
      json_.field("default", key.otherwise);
    }
    forms(key.forms);
    json_.end_object();
  }

  void forms(const Forms& forms) {
    const bool words = has(forms, Kind::number);  // a number that has its own form is no text
    if (forms.size() == 1 && !kind_.draws) {
      form(forms[0], words);
      return;
    }
    json_.key("anyOf").begin_array();
    for (const Form& one : forms) {
      json_.begin_object();
      form(one, words);
      json_.end_object();
    }
    if (kind_.draws) json_.begin_object().field("$ref", "#/definitions/distribution").end_object();
    json_.end_array();
  }

  void form(const Form& form, bool words) {
    switch (form.kind) {
      case Kind::number:
        json_.field("type", "number");
        if (std::isfinite(form.bounds.least))
          json_.field(form.bounds.least_open ? "exclusiveMinimum" : "minimum", form.bounds.least);
        if (std::isfinite(form.bounds.most)) json_.field("maximum", form.bounds.most);
        return;
      case Kind::integer:
        json_.field("type", "integer").field("minimum", form.least).field("maximum", form.most);
        return;
      case Kind::text:
        json_.key("type").begin_array().value("string");
        if (!words) json_.value("number");
        json_.end_array().field("minLength", 1);
        if (form.words.empty()) return;
        json_.list("examples", form.words);
        return;
      case Kind::time:
        json_.field("type", "string").field("pattern", "^[0-9]{4}-[0-9]{2}-[0-9]{2}");
        return;
      case Kind::flag:
        json_.key("enum").begin_array().value(true).value(false);
        for (const char* word : {"on", "off", "yes", "no"}) json_.value(word);
        json_.end_array();
        return;
      case Kind::choice:
        json_.key("enum").begin_array();
        for (const auto& word : form.words) {
          json_.value(word);
          if (is_number(word)) json_.raw(word);
        }
        json_.end_array();
        return;
      case Kind::list:
        json_.field("type", "array").key("items").begin_object();
        forms(form.items);
        json_.end_object().field("minItems", int(form.fewest));
        if (form.greatest > 0) json_.field("maxItems", int(form.greatest));
        return;
      case Kind::map:
        json_.field("$ref", "#/definitions/" + form.section().name);
        return;
    }
  }

  void distribution() {
    const auto one_key = [&](const char* key, const char* what, const char* value) {
      json_.begin_object().field("type", "object").field("additionalProperties", false);
      json_.key("required").begin_array().value(key).end_array();
      json_.key("properties").begin_object().key(key);
      json_.raw(std::string(R"({"description":")") + what + R"(",)" + value + "}");
      json_.end_object().end_object();
    };
    json_.key("distribution").begin_object();
    json_.field("description", "What the value is drawn from, anew for each seed.");
    json_.key("anyOf").begin_array();
    one_key("uniform", "[least, most]: numbers, or two times.",
            R"("type":"array","items":{"type":["number","string"]},"minItems":2,"maxItems":2)");
    one_key(
        "log_uniform", "[least, most]: positive numbers; the logarithm is uniform.",
        R"("type":"array","items":{"type":"number","exclusiveMinimum":0},"minItems":2,"maxItems":2)");
    one_key(
        "normal", "{mean, sigma, min, max}: min and max may be left out.",
        R"("type":"object","properties":{"mean":{"type":"number"},"sigma":{"type":"number","exclusiveMinimum":0},"min":{"type":"number"},"max":{"type":"number"}},"required":["mean","sigma"],"additionalProperties":false)");
    one_key("integers", "[least, most]: whole numbers, both ends included.",
            R"("type":"array","items":{"type":"integer"},"minItems":2,"maxItems":2)");
    one_key("one_of", "Any values, equally likely.", R"("type":"array","minItems":1)");
    json_.end_array().end_object();
  }

  const FileKind& kind_;
  JsonWriter json_;
};

std::string escaped(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.insert(at, "\\");
  return text;
}

std::string quoted(const std::string& word) { return "`" + word + "`"; }

std::string range_text(const Form& form) {
  if (form.kind == Kind::integer)
    return " " + std::to_string(form.least) + " to " + std::to_string(form.most);
  const bool least = std::isfinite(form.bounds.least), most = std::isfinite(form.bounds.most);
  const std::string from = shortest_text(form.bounds.least), to = shortest_text(form.bounds.most);
  if (least && most && !form.bounds.least_open) return " " + from + " to " + to;
  std::string text;
  if (least) text += (form.bounds.least_open ? " > " : " >= ") + from;
  if (most) text += (least ? ", <= " : " <= ") + to;
  return text;
}

/// Writes a page of documents.
class PageWriter {
 public:
  explicit PageWriter(const FileKind& kind) : kind_(kind) {}

  std::string text() {
    const std::string name(kind_.name);
    text_ = "# Keys of a " + name + " file\n\nWritten by `dmise schema " + name +
            " --markdown > docs/reference/" + name +
            ".md` from the tables that its readers read by.\n"
            "`dmise schema " +
            name +
            "` prints the same as JSON Schema. An editor with the YAML language server completes\n"
            "and checks a file by it that begins with this line:\n\n"
            "    # yaml-language-server: $schema=" +
            "/usr/share/dmise/schema/" + name +
            ".schema.json\n\nA flag is `on`, `off`, `true`, `false`, `yes` or `no`.\n";
    for (const Section* section : sections_within(kind_.section()))
      if (!page_of(*section)) table(*section);
    return text_;
  }

 private:
  /// The page of another kind of file that documents a section; null: this one.
  const FileKind* page_of(const Section& section) const {
    if (kind_.section == camera_section) return nullptr;
    static const std::vector<const Section*> of_cameras = sections_within(camera_section());
    const bool there =
        std::find(of_cameras.begin(), of_cameras.end(), &section) != of_cameras.end();
    return there ? &kinds[2] : nullptr;
  }

  void table(const Section& section) {
    text_ += "\n## " + section.name + "\n\n" + section.what + "\n\n";
    text_ += "| key | value | default | meaning |\n|---|---|---|---|\n";
    for (const Key& key : section.keys) row(quoted(key.name), key);
    if (section.any_other) row("any", *section.any_other);
  }

  void row(const std::string& name, const Key& key) {
    const std::string otherwise = key.required && name != "any" ? "needed" : key.otherwise;
    text_ += "| " + name + " | " + escaped(values(key.forms)) + " | " + escaped(otherwise) + " | " +
             escaped(key.what) + " |\n";
  }

  std::string values(const Forms& forms) const {
    std::string text;
    for (const Form& form : forms) text += (text.empty() ? "" : " or ") + value(form);
    return text;
  }

  std::string value(const Form& form) const {
    switch (form.kind) {
      case Kind::number:
        return "number" + range_text(form);
      case Kind::integer:
        return "integer" + range_text(form);
      case Kind::text:
        return "text";
      case Kind::time:
        return "UTC";
      case Kind::flag:
        return "flag";
      case Kind::choice: {
        std::string text;
        for (const auto& word : form.words) text += (text.empty() ? "" : ", ") + quoted(word);
        return text;
      }
      case Kind::list:
        return "list of " +
               (form.greatest > 0 ? std::to_string(form.greatest) + ": " : std::string()) +
               values(form.items);
      case Kind::map: {
        const Section& section = form.section();
        const FileKind* page = page_of(section);
        return "[" + section.name + "](" + (page ? std::string(page->name) + ".md" : "") + "#" +
               section.name + ")";
      }
    }
    return "";
  }

  const FileKind& kind_;
  std::string text_;
};

}  // namespace

std::span<const FileKind> file_kinds() { return kinds; }

std::vector<const Section*> sections_within(const Section& section) {
  std::vector<const Section*> found;
  find_within(section, found);
  return found;
}

std::string json_schema(const FileKind& kind) { return SchemaWriter(kind).text() + "\n"; }

std::string schema_markdown(const FileKind& kind) { return PageWriter(kind).text(); }

}  // namespace dmise
