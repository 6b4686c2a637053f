#include "time-master/announce.h"

#include <unistd.h>

#include "core/base/error.h"
#include "core/base/files/whole_file.h"

namespace dmise {

void announce(const std::string& address, const std::string& file, int descriptor,
              const std::function<void(const std::string& address)>& on_bound) {
  const std::string line = address + "\n";
  if (!file.empty()) write_file_whole(file, line);
  if (descriptor >= 0 && write(descriptor, line.data(), line.size()) != ssize_t(line.size()))
    throw Error("announce-fd: can't write");
  if (on_bound) on_bound(address);
}

}  // namespace dmise
