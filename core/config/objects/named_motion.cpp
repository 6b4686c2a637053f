#include "core/config/objects/named_motion.h"

#include "core/base/error.h"
#include "core/config/objects/object_names.h"
#include "core/orbit/elements/catalogue.h"

namespace dmise {
namespace {

std::vector<MeanElements> elements_of(const ObjectSource& source) {
  if (source.walker) return elements_of(*source.walker);
  return source.path.empty() ? std::vector<MeanElements>() : read_catalogue(source.path).elements;
}

}  // namespace

StatedModel motion_named(const std::string& name, const std::vector<OwnObject>& own,
                         const std::vector<ObjectSource>& catalogues) {
  std::vector<std::string> names;
  for (const OwnObject& object : own) {
    if (is_called(object, name)) {
      if (object.motion.proximity) throw Error("it moves near another object itself");
      return object.motion.model;
    }
    names.push_back(object.name);
  }
  for (const ObjectSource& source : catalogues)
    for (const MeanElements& e : elements_of(source)) {
      if (is_called(e, name)) return e;
      names.push_back(e.name);
    }
  const std::string hint = nearest_object(name, names);
  throw Error("no object has this name or number" +
              (hint.empty() ? "" : ", did you mean " + hint + "?"));
}

}  // namespace dmise
