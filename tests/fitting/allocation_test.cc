// SPDX-License-Identifier: Apache-2.0
//
// Tests that the functions which a solver calls repeatedly allocate no memory, for recordings too short for several
// threads. It is a separate program: it replaces operator new, and is linked with --wrap=malloc to see Eigen's
// allocations too.
#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "tests/fitting/trajectory_cost_examples.h"

namespace {
std::atomic<int> allocations = 0;
}  // namespace

extern "C" {
void* __real_malloc(std::size_t size);
void* __wrap_malloc(std::size_t size) {
  ++allocations;
  return __real_malloc(size);
}
}

// Not inlined; otherwise g++ warns that new and delete do not match.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto align = static_cast<std::size_t>(alignment);
  if (void* const memory = std::aligned_alloc(align, (size + align - 1) / align * align)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

namespace pendulum::allocation_test {
namespace {

TEST(Allocations, AreDetected) {
  int before = allocations;
  const Eigen::VectorXd vector = Eigen::VectorXd::Constant(1000, allocations);
  EXPECT_EQ(allocations - before, 1) << vector.sum();
  before = allocations;
  void* const memory = ::operator new(4);  // called as a function, because a compiler may remove a new-expression
  EXPECT_EQ(allocations - before, 1) << memory;
  ::operator delete(memory);
  before = allocations;
  void* const aligned = ::operator new (64, std::align_val_t{64});
  EXPECT_EQ(allocations - before, 1) << aligned;
  ::operator delete (aligned, std::align_val_t{64});
}

/// Evaluates residuals, and optionally derivatives, as Ceres does, each time at a different point.
void EvaluateAtManyPoints(const TrajectoryCost& cost, const std::vector<double>& at, bool with_jacobians) {
  std::array<double, 16> p{};
  std::array<double, 16> residuals{};
  std::array<std::array<double, 16>, 16> jacobian{};
  std::array<double*, 16> jacobians{};
  std::array<const double*, 16> blocks{};
  for (std::size_t i = 0; i < at.size(); ++i) {
    p[i] = at[i];
    blocks[i] = &p[i];
    jacobians[i] = jacobian[i].data();
  }
  for (int evaluation = 0; evaluation < 5; ++evaluation) {
    p[0] *= 1.0001;
    EXPECT_TRUE(cost.Evaluate(blocks.data(), residuals.data(), with_jacobians ? jacobians.data() : nullptr));
  }
}

void ExpectNoAllocations(const NoiseModel& noise) {
  ForEachCase([&](const MotionModel& model, StartKind start, Quantity quantity) {
    const std::vector<double> p = TypicalParameters(model, start);
    const TrajectoryData data = Simulated(model, start, quantity, 2000, p, 0.003);
    const std::unique_ptr<TrajectoryCost> cost = MakeTrajectoryCost(model, start, data);
    cost->set_noise(noise);
    for (const bool with_jacobians : {true, false}) {
      EvaluateAtManyPoints(*cost, p, with_jacobians);  // allocates the working memory
      const int before = allocations;
      EvaluateAtManyPoints(*cost, p, with_jacobians);
      EXPECT_EQ(allocations - before, 0) << "with derivatives: " << with_jacobians;
    }
  });
}

TEST(Allocations, DoNotOccurInLeastSquares) { ExpectNoAllocations({}); }

TEST(Allocations, DoNotOccurInTheLikelihoodOfLevels) {
  NoiseModel noise;
  noise.family = NoiseFamily::kQuantized;
  noise.sigma = 0.002;
  noise.resolution = 0.0035;
  ExpectNoAllocations(noise);
}

}  // namespace
}  // namespace pendulum::allocation_test
