#pragma once
#include <string>

#include "core/score/score.h"

namespace dmise {

/// Tables to read.
std::string score_table(const Score& score);

/// One JSON object; figures that are not known are null.
std::string score_json(const Score& score);

/// A line per truth and per false alarm, after a header.
std::string score_csv(const Score& score);

}  // namespace dmise
