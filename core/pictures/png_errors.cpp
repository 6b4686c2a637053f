#include <dlfcn.h>

#include <array>
#include <atomic>
#include <cstdlib>

// libpng prints an error on stderr after a handler that returns, as OpenImageIO's handlers do. This
// definition of `png_set_error_fn`, which OpenImageIO finds before libpng's, makes them leave by
// `png_longjmp` instead. Thread-safe: the only state is the table of handlers.
namespace {

using Handler = void (*)(void* png, const char* message);

template <class Function>
Function of_libpng(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

/// Handlers of OpenImageIO: one reads, one writes.
std::array<std::atomic<Handler>, 2> handlers{};

template <std::size_t Index>
void report_error(void* png, const char* message) {
  handlers[Index].load()(png, message);
  static const auto png_longjmp = of_libpng<void (*)(void*, int)>("png_longjmp");
  png_longjmp(png, 1);
  std::abort();  // never reached
}

/// Returns a handler that calls `handler` and does not return; `handler` itself if there are more
/// than two.
Handler not_returning(Handler handler) {
  constexpr std::array<Handler, 2> reports{report_error<0>, report_error<1>};
  for (std::size_t i = 0; i < handlers.size(); ++i) {
    Handler known = nullptr;
    if (handlers[i].compare_exchange_strong(known, handler) || known == handler) return reports[i];
  }
  return handler;
}

}  // namespace

extern "C" void png_set_error_fn(void* png, void* context, Handler error, Handler warning) {
  static const auto set = of_libpng<void (*)(void*, void*, Handler, Handler)>("png_set_error_fn");
  set(png, context, error ? not_returning(error) : nullptr, warning);
}
