#include "launch/run/star_catalogue_option.h"

namespace dmise {

CLI::Option* add_star_catalogue_option(CLI::App& command, std::string& name, bool may_be_none) {
  return command.add_option("--catalogue", name,
                            std::string("star catalogue: kstars, tycho2, ") +
                                (may_be_none ? "a file, or none" : "or a file") +
                                "; by default kstars");
}

}  // namespace dmise
