#include "core/propagation/object_population.h"

#include "core/base/error.h"

namespace dmise {

ObjectRoster published_roster(const ObjectPopulation& population) {
  ObjectRoster roster = population.roster;
  roster.elements = population.elements;
  return roster;
}

ObjectPopulation population_of(const ObjectRoster& roster, const std::vector<OwnObject>& own,
                               const Ellipsoid& ellipsoid, const ObjectModels& models) {
  ObjectPopulation population{
      .roster = {.objects = roster.objects}, .elements = roster.elements, .ellipsoid = ellipsoid};
  std::size_t own_by_elements = 0;
  for (const auto& object : own)
    own_by_elements += std::holds_alternative<MeanElements>(object.motion.model);
  const std::size_t by_elements = roster.elements.size();
  if (by_elements < own_by_elements ||
      by_elements + own.size() - own_by_elements != roster.objects.size())
    throw Error("the roster is not of this scenario: " + std::to_string(roster.objects.size()) +
                " objects, " + std::to_string(by_elements) + " of them with elements");
  std::size_t with_elements = by_elements - own_by_elements, with_model = by_elements;
  // As loaded: own objects in the scenario's order, those of SGP4 first.
  std::vector<const OwnObject*> object_at(roster.objects.size(), nullptr);
  for (const auto& object : own) {
    const auto* model = std::get_if<MotionModel>(&object.motion.model);
    const std::size_t i = model ? with_model++ : with_elements++;
    if (roster.objects[i].name != object.name)
      throw Error("the roster is not of this scenario: " + roster.objects[i].name +
                  " in the place of " + object.name);
    if (model) population.models.push_back(*model);
    object_at[i] = &object;
  }
  for (std::size_t i = 0; i < by_elements - own_by_elements; ++i)
    if (const auto* model = models.of(roster.objects[i].name, roster.objects[i].catalogue_number))
      population.attitudes.push_back({i, model->attitude.model});
  for (std::size_t i = by_elements - own_by_elements; i < object_at.size(); ++i)
    if (object_at[i]->attitude) population.attitudes.push_back({i, object_at[i]->attitude->model});
  return population;
}

ObjectPopulation only_these(const ObjectPopulation& all, const std::set<std::size_t>& indices) {
  ObjectPopulation some;
  some.ellipsoid = all.ellipsoid;
  for (const std::size_t i : indices) {
    for (const auto& attitude : all.attitudes)
      if (attitude.object == i)
        some.attitudes.push_back({some.roster.objects.size(), attitude.model});
    some.roster.objects.push_back(all.roster.objects[i]);
    if (i < all.elements.size())
      some.elements.push_back(all.elements[i]);
    else
      some.models.push_back(all.models[i - all.elements.size()]);
  }
  return some;
}

}  // namespace dmise
