#include <spdlog/spdlog.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "time-master/master.h"

namespace dmise {

void announce(const MasterOptions& options, const std::string& address) {
  spdlog::debug("listens on {}", address);
  const std::string line = address + "\n";
  if (!options.announce_file.empty()) write_file_whole(options.announce_file, line);
  if (options.announce_fd >= 0 &&
      write(options.announce_fd, line.data(), line.size()) != ssize_t(line.size()))
    throw Error("announce-fd: can't write");
  if (options.on_bound) options.on_bound(address);
}

}  // namespace dmise
