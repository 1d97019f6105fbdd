// Verb `device`: a simulated device that answers as a device in a laboratory does, for practising the verb `tune`.
#pragma once

#include "studies/inverse/practice_device.h"
#include "verbs/laboratory.h"
#include "verbs/study.h"

namespace softland::verbs {

struct DeviceRequest {
  LaboratoryArguments laboratory;
  PracticeOptions practice;

  [[nodiscard]] PracticeOptions options(const SceneFile& file) const;
};
/// Reads the options of the verb `device` from the arguments. Throws InvalidRequest.
[[nodiscard]] DeviceRequest device_request(const Arguments& arguments);

}  // namespace softland::verbs
