#include "sensors/sensor_stream.h"

namespace waretwin {

Stamp stamp_of(const SensorEvent& event) {
  return std::visit([](const auto& measurement) { return measurement.stamp; }, event);
}

}  // namespace waretwin
