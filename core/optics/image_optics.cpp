#include "core/optics/image_optics.h"

#include "core/base/stopwatch.h"

namespace dmise {

std::span<const ImageParameter> image_parameters() {
  static const std::vector<ImageParameter> all = [] {
    std::vector<ImageParameter> list;
    ImageEffects::for_each([&]<class Effect>() {
      const auto own = Effect::parameters();
      list.insert(list.end(), own.begin(), own.end());
    });
    return list;
  }();
  return all;
}

ImageOptics acting_optics(const ImageOptics& optics, const EffectSet& effects) {
  ImageOptics acting = optics;
  ImageEffects::for_each([&]<class Effect>() {
    if (!effects.has(Effect::facts)) static_cast<Effect&>(acting).switch_off();
  });
  return acting;
}

void apply_image_optics(const ImageOptics& acting, ExpectedElectronImage& image, Threads& threads,
                        EffectTimes& times) {
  ImageEffects::for_each([&]<class Effect>() {
    const Effect& effect = acting;
    if (!effect.applies()) return;
    Stopwatch timing(times[Effect::facts]);
    effect.apply(image, threads);
  });
}

}  // namespace dmise
