#pragma once
#include <sys/resource.h>

#include <csignal>

namespace dmise::test {

/// While it lives, no file of this process grows beyond `max_bytes`: what a full disk is, but for
/// the name of the error, "File too large".
class FullDisk {
 public:
  explicit FullDisk(rlim_t max_bytes) : listener_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &limit_);
    const rlimit less{max_bytes, limit_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &less);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &limit_);
    std::signal(SIGXFSZ, listener_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  void (*listener_)(int);
  rlimit limit_{};
};

}  // namespace dmise::test
