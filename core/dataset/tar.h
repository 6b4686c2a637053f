#pragma once
#include <string>
#include <string_view>

namespace dmise {

/// A member of a tar archive (POSIX ustar): header, content, padding to 512 bytes. Members one
/// after the other and `tar_end` make an archive. Owner 0, mode 0644, time 0: equal content gives
/// equal bytes. Throws `Error` for a name of more than 100 bytes or 8 GiB of content.
std::string tar_member(std::string_view name, std::string_view content);

/// The two empty blocks that end an archive.
std::string tar_end();

}  // namespace dmise
