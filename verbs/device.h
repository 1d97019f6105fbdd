// Verb `device`: a simulated device that answers as a laboratory device does, to practise on.
#pragma once

#include "studies/inverse/practice_device.h"
#include "verbs/laboratory.h"
#include "verbs/study.h"

namespace softland::verbs {

struct DeviceRequest {
  ToldErrors laboratory;
  PracticeOptions practice;

  [[nodiscard]] PracticeOptions options(const SceneFile& file) const;
};
/// Reads the request. Throws InvalidRequest.
[[nodiscard]] DeviceRequest device_request(const Arguments& arguments);

}  // namespace softland::verbs
