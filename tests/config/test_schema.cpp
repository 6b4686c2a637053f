#include "core/config/schema.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <span>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/config/scenario.h"
#include "core/config/scenario_text.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

void expect_described(const Key& key, const std::string& place) {
  EXPECT_GT(key.what.size(), 3u) << place << ": says nothing";
  EXPECT_TRUE(key.what.ends_with('.')) << place << ": " << key.what << ": no sentence";
  EXPECT_FALSE(key.forms.empty()) << place << ": has no type";
  EXPECT_FALSE(key.required && !key.otherwise.empty()) << place << ": needs no default";
}

TEST(Schema, DescribesEveryKeyThatAReaderTakes) {
  for (const FileKind& kind : file_kinds())
    for (const Section* section : sections_within(kind.section())) {
      EXPECT_FALSE(section->what.empty()) << section->name;
      std::set<std::string> names;
      for (const Key& key : section->keys) {
        EXPECT_TRUE(names.insert(key.name).second) << section->name << ": " << key.name;
        expect_described(key, section->name + "." + key.name);
      }
      if (section->any_other) expect_described(*section->any_other, section->name);
    }
}

TEST(Schema, ItsPagesAreUpToDate) {
  for (const FileKind& kind : file_kinds()) {
    if (kind.draws) continue;  // as scenario
    const std::string name(kind.name);
    EXPECT_EQ(read_text_file(DMISE_SOURCE_DIR "/docs/reference/" + name + ".md"),
              schema_markdown(kind))
        << "dmise schema " << name << " --markdown > docs/reference/" << name << ".md";
  }
}

/// Whether a file may have `text` in this form.
bool accepts(const Form& form, const std::string& text) {
  const auto number = parse_real(text);
  switch (form.kind) {
    case Form::Kind::number:
      return number && *number <= form.bounds.most &&
             (form.bounds.least_open ? *number > form.bounds.least : *number >= form.bounds.least);
    case Form::Kind::integer:
      return number && *number == std::int64_t(*number) && *number >= double(form.least) &&
             *number <= double(form.most);
    case Form::Kind::flag:
      return text == "on" || text == "off";
    case Form::Kind::choice:
      return std::ranges::find(form.words, text) != form.words.end();
    case Form::Kind::text:
      return true;
    default:
      return false;
  }
}

// A default of several words, a list, or a word for a number is for readers of the page.
TEST(Schema, EveryDefaultIsAValueThatItsKeyMayHave) {
  std::size_t checked = 0;
  for (const FileKind& kind : file_kinds())
    for (const Section* section : sections_within(kind.section()))
      for (const Key& key : section->keys) {
        if (key.otherwise.empty() || key.otherwise.find_first_of(" [") != std::string::npos)
          continue;
        const bool has_words = std::ranges::any_of(key.forms, [](const Form& form) {
          return form.kind == Form::Kind::flag || form.kind == Form::Kind::choice ||
                 form.kind == Form::Kind::text;
        });
        if (!has_words && !parse_real(key.otherwise)) continue;
        ++checked;
        EXPECT_TRUE(std::ranges::any_of(
            key.forms, [&](const Form& form) { return accepts(form, key.otherwise); }))
            << section->name << "." << key.name << ": " << key.otherwise;
      }
  EXPECT_GT(checked, 100u);
}

using Way = std::vector<std::string>;  // keys, and numbers of items, from a file to a value

YAML::Node at(const YAML::Node& node, std::span<const std::string> way) {
  if (way.empty()) return node;
  return at(node.IsSequence() ? node[std::stoul(way[0])] : node[way[0]], way.subspan(1));
}

struct GivenKey {
  Way map;
  const Key* key;
};

void collect(const YAML::Node& value, const Forms& forms, const Way& way,
             std::vector<GivenKey>& found) {
  for (const Form& form : forms) {
    if (form.kind == Form::Kind::list && value.IsSequence()) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        Way item = way;
        item.push_back(std::to_string(i));
        collect(value[i], form.items, item, found);
      }
    } else if (form.kind == Form::Kind::map && value.IsMap()) {
      for (const Key& key : form.section().keys)
        if (const YAML::Node inner = value[key.name]) {
          found.push_back({way, &key});
          Way here = way;
          here.push_back(key.name);
          collect(inner, key.forms, here, found);
        }
    }
  }
}

/// What determines the products; empty if it is no scenario.
std::string physics_of(const YAML::Node& scenario, const std::string& path) {
  try {
    return physics_json(scenario_of_text(YAML::Dump(scenario), path));
  } catch (const ConfigError&) {
    return "";
  }
}

// Every key of every_key is tried that its other keys do not need. The digest has some only if they
// are given, as what else says the value may be another; and two defaults are rounded radians.
TEST(Schema, ADefaultIsWhatHoldsWithoutTheKey) {
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  const std::string path = DMISE_SOURCE_DIR "/tests/docs/every_key/scenario.yaml";
  const YAML::Node all = YAML::LoadFile(path);
  std::vector<GivenKey> given;
  collect(all, form::map(file_kinds()[0].section), {}, given);
  const std::set<std::string> only_if_given{"albedo", "angstrom_exponent", "ground_albedo",
                                            "solar_flux_sfu"},
      rounded{"half_width_deg", "height_deg"};
  std::set<const Key*> compared;
  for (const GivenKey& one : given) {
    const Key* key = one.key;
    if (only_if_given.contains(key->name) || rounded.contains(key->name)) continue;
    if (compared.contains(key) || std::ranges::none_of(key->forms, [&](const Form& form) {
          return form.kind != Form::Kind::text && accepts(form, key->otherwise);
        }))
      continue;
    const YAML::Node with = YAML::Clone(all), without = YAML::Clone(all);
    at(with, one.map)[key->name] = key->otherwise;
    at(without, one.map).remove(key->name);
    const std::string stated = physics_of(with, path), absent = physics_of(without, path);
    if (stated.empty() || absent.empty()) continue;
    compared.insert(key);
    EXPECT_EQ(stated, absent) << key->name << ": " << key->otherwise;
  }
  EXPECT_GT(compared.size(), 100u);
}

TEST(Schema, StatesTheGreatestSeedAndBothRangesOfACoefficient) {
  const std::string page = schema_markdown(file_kinds()[0]);
  EXPECT_NE(page.find("| `seed` | integer 0 to 9223372036854775807 |"), std::string::npos);
  const std::string camera = schema_markdown(file_kinds()[2]);
  for (const char* range :
       {"-1000 to 1000 with `kannala_brandt`", "-10000 to 10000 with `brown_conrady`"})
    EXPECT_NE(camera.find(range), std::string::npos) << range;
}

const Section& lens_section() {
  static const Section section{"lens",
                               "A lens.",
                               {required("pitch_m", form::above(0.0, 1.0), "Pitch [m]."),
                                optional("gain", form::number(1.0, 9.0), "Gain.", "2"),
                                optional("sharp", form::flag(), "Sharp.", "on"),
                                optional("pitch", form::flag(), "Not read here.")}};
  return section;
}

std::string complaint(const std::string& text) {
  try {
    YamlMap map(YamlValue::parse(text, "l.yaml"), lens_section());
    map.number("pitch_m");
    map.number("gain");
    map.flag("sharp");
    map.done();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(Section, GivesReadersTheirRanges) {
  EXPECT_EQ(complaint("pitch_m: 1\ngain: 9\n"), "");
  EXPECT_EQ(complaint("pitch_m: 0\n"), "l.yaml:1:10: pitch_m: must be > 0, got 0");
  EXPECT_EQ(complaint("pitch_m: 1.5\n"), "l.yaml:1:10: pitch_m: must be <= 1, got 1.5");
  EXPECT_EQ(complaint("pitch_m: 1\ngain: 0\n"), "l.yaml:2:7: gain: must be >= 1, got 0");
}

// Which keys go together is up to a reader: that it did not ask for one does not make it unknown.
TEST(Section, AKeyThatIsNotReadBesideOthersIsNotCalledUnknown) {
  EXPECT_EQ(complaint("pitch_m: 1\npitch: on\n"),
            "l.yaml:2:1: pitch: goes with other keys or values than those given");
  EXPECT_EQ(complaint("pitch: on\n"), "l.yaml:1:1: pitch_m: is missing");
  EXPECT_EQ(complaint("pitch_m: 1\ngan: 3\n"), "l.yaml:2:1: gan: unknown key, did you mean gain?");
}

TEST(Section, LetsReadersTakeNothingThatItDoesNotSay) {
  YamlMap map(YamlValue::parse("pitch_m: 1\nother: 1\n", "l.yaml"), lens_section());
  EXPECT_THROW(map.find("other"), std::logic_error);              // a key that it lacks
  EXPECT_THROW(map.require("pitch_m").flag(), std::logic_error);  // another type
}

TEST(Section, GivesReadersItsDefaults) {
  YamlMap map(YamlValue::parse("pitch_m: 1\n", "l.yaml"), lens_section());
  EXPECT_EQ(map.number("gain"), 2.0);
  EXPECT_TRUE(map.flag("sharp"));
  EXPECT_THROW(map.flag("pitch"), ConfigError);  // it has none
}

}  // namespace
}  // namespace dmise
