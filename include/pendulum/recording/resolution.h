#pragma once
#include <Eigen/Core>
namespace pendulum { inline double FindResolution(const Eigen::VectorXd&) { return 0; } }
