#pragma once
#include "core/image/charts/chart.h"
#include "core/score/score.h"

namespace dmise {

/// Probability of detection against the expected SNR, with 95 % intervals and theory.
Chart detection_chart(const Score& score);
/// Errors of position across the trail against the expected SNR, over their Cramer-Rao bound.
Chart position_chart(const Score& score);
/// Errors of flux against the expected SNR, with the bound of a known place and shape.
Chart magnitude_chart(const Score& score);

}  // namespace dmise
