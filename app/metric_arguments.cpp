#include "app/metric_arguments.h"

namespace ltcfit::app {

void addMetricOptions(CLI::App& command, MetricOptions& metrics) {
  command.add_option("--samples", metrics.samples, "Directions of fit and lobe for SW1, TV, L3; 16..4194304")
      ->check(CLI::Range(16, 1 << 22))
      ->capture_default_str();
  command.add_option("--directions", metrics.directions, "Projections for SW1; 1..65536")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  command.add_option("--quads", metrics.quads, "Random quads for form; 1..65536")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  command.add_option("--lights", metrics.lights, "Random lights of each size, to measure with; 1..65536")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
}

}  // namespace ltcfit::app
