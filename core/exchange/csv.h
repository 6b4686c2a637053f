#pragma once
#include <string>
#include <vector>

namespace dmise {

struct ExportRequest;
struct ExportedFile;

/// All fields of the lines of detections.jsonl or truth.jsonl and of frames.jsonl as tables (RFC
/// 4180), numbers with the digits that they have there. Elements of lists get a suffix: _x _y _z of
/// vectors and places, _xx _xy _yy of covariances, _1 _2 ... of others; an object's keys its name.
std::vector<ExportedFile> csv_files(const ExportRequest& request);

}  // namespace dmise
