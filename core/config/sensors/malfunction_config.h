#pragma once
#include <vector>

#include "core/config/yaml/yaml_reader.h"
#include "core/instrument/malfunction.h"

namespace dmise {

const Section& malfunction_section();
std::vector<Malfunction> read_malfunctions(const YamlValue& list);

}  // namespace dmise
