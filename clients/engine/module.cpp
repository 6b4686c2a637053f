#include <nanobind/nanobind.h>

#include <chrono>
#include <exception>

#include "clients/engine/engine.h"
#include "core/base/detached_work.h"
#include "core/base/version.h"
#include "core/config/yaml/search_path.h"

namespace nb = nanobind;

namespace dmise {
namespace {

/// Sets Python's exception of dmise.errors; what is not UTF-8 in the text is replaced.
void raise(const char* name, const std::exception& error) {
  const std::string text = error.what();
  const nb::object message =
      nb::steal(PyUnicode_DecodeUTF8(text.data(), Py_ssize_t(text.size()), "replace"));
  const nb::object kind = nb::module_::import_("dmise.errors").attr(name);
  PyErr_SetObject(kind.ptr(), message.ptr());
}

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const ScenarioFault& error) {
    raise("ScenarioError", error);
  } catch (const ConfigError& error) {
    raise("InputError", error);
  } catch (const Error& error) {
    raise("EngineError", error);
  }
}

}  // namespace
}  // namespace dmise

NB_MODULE(_engine, module) {
  nb::register_exception_translator(dmise::translate);
  module.def("home_directory", &dmise::home_directory);
  module.def("software_name", &dmise::software_name);
  module.def("wait_for_detached", [](double time_s) {
    nb::gil_scoped_release without;
    return dmise::wait_for_detached(std::chrono::milliseconds(long(time_s * 1e3)));
  });
  dmise::add_simulation(module);
  dmise::add_frames_of_cameras(module);
  dmise::add_catalogues(module);
  dmise::add_samples(module);
}
