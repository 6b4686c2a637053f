#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace dmise {

/// Commands or options of a program that help shows, in its order.
std::vector<const CLI::App*> shown_commands(const CLI::App& app);
std::vector<const CLI::Option*> shown_options(const CLI::App& app);

/// Returns the manual page (roff, section 1) of a program or of one of its commands, with the texts
/// of its help. `name`: of the page, as dmise-run for `dmise run`; `see_also`: names of other
/// pages.
std::string manual_page(const CLI::App& app, const std::string& name, const std::string& version,
                        const std::vector<std::string>& see_also);

}  // namespace dmise
