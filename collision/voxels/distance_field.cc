#include "collision/voxels/distance_field.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "common/numbers.h"

namespace planbench {
namespace {

/// Squared distances are whole numbers, exact in floats up to here.
static_assert(3LL * kMaxVoxelsAlongAxis * kMaxVoxelsAlongAxis < (1 << 24));

/// Lines of cells that are handled together, side by side: a cache line wide.
constexpr int kLines = 16;

/// Lowers values f along lines of cells to min over j of f(j) + (i - j)^2.
class LinePass {
 public:
  /// Lines of `length` cells, with walls (f = 0) before the first and after the last, or without.
  LinePass(int length, bool walls)
      : length_(length),
        first_(walls ? -1 : 0),
        last_(walls ? length : length - 1),
        rows_(static_cast<std::size_t>(length) + 2, Row::Zero()),
        parabolas_(rows_.size()) {}

  /// In place; `width` lines, at most kLines: their cells i stand at values + i * stride.
  void Run(float* values, std::size_t stride, int width) {
    for (int i = 0; i < length_; ++i) {
      Row& row = RowAt(i);
      row.setZero();
      std::copy_n(values + static_cast<std::size_t>(i) * stride, width, row.data());
    }
    const int done = Search(values, stride, width);
    if (done < length_) {
      for (int line = 0; line < width; ++line) Sweep(line, done, values + line, stride);
    }
  }

 private:
  using Row = Eigen::Array<float, kLines, 1>;

  struct Parabola {
    std::int32_t at;
    std::int32_t height;
    std::int32_t At(int i) const { return (i - at) * (i - at) + height; }
    std::int64_t AtZero() const { return std::int64_t{at} * at + height; }
  };

  Row& RowAt(int i) { return rows_[static_cast<std::size_t>(i + 1)]; }

  /// Looks at ever further cells j, on all lines at once, until (i - j)^2 says that no better one
  /// can come. Gives up when that has taken more steps than a constant a cell; returns the number
  /// of cells done.
  int Search(float* to, std::size_t stride, int width) {
    constexpr int kStepsPerCell = 32;
    int steps = kStepsPerCell * length_;
    for (int i = 0; i < length_ && steps > 0; ++i) {
      Row best = RowAt(i);
      float worst = best.maxCoeff();
      const int reach = std::max(i - first_, last_ - i);
      int d = 1;
      while (d <= reach && static_cast<float>(d * d) < worst) {
        const int until = std::min(reach, d + 3);
        steps -= 4;
        for (; d <= until; ++d) {
          const auto square = static_cast<float>(d * d);
          if (i - d >= first_) best = best.min(RowAt(i - d) + square);
          if (i + d <= last_) best = best.min(RowAt(i + d) + square);
        }
        worst = best.maxCoeff();
      }
      std::copy_n(best.data(), width, to + static_cast<std::size_t>(i) * stride);
      if (steps <= 0) return i + 1;
    }
    return length_;
  }

  /// The same along one line, from cell `begin` on, by the lower envelope of all parabolas.
  void Sweep(int line, int begin, float* to, std::size_t stride) {
    Parabola* const bottom = parabolas_.data();
    Parabola* top = bottom - 1;
    for (int j = first_; j <= last_; ++j) {
      const float height = RowAt(j)[line];
      if (height == kInfinity) continue;
      const Parabola added{j, static_cast<std::int32_t>(height)};
      while (top > bottom && Hidden(top[-1], top[0], added)) --top;
      *++top = added;
    }
    const Parabola* lowest = bottom;
    for (int i = begin; i < length_; ++i) {
      float& value = to[static_cast<std::size_t>(i) * stride];
      if (top < bottom) {
        value = kInfinity;
        continue;
      }
      while (lowest < top && lowest[1].At(i) <= lowest->At(i)) ++lowest;
      value = static_cast<float>(lowest->At(i));
    }
  }

  /// True if `b` is nowhere below both others: the crossing of a and b is not left of that of b
  /// and c.
  static bool Hidden(const Parabola& a, const Parabola& b, const Parabola& c) {
    return (b.AtZero() - a.AtZero()) * (c.at - b.at) >= (c.AtZero() - b.AtZero()) * (b.at - a.at);
  }

  int length_;
  int first_, last_;                 // cells with values, walls among them
  std::vector<Row> rows_;            // of cells -1 to length; walls are 0
  std::vector<Parabola> parabolas_;  // the envelope, from left to right
};

/// Squared distances along a row of cells.
void PassX(const std::uint8_t* cells, int length, bool walls, float* squares) {
  float distance = walls ? 0 : kInfinity;
  for (int i = 0; i < length; ++i) {
    distance = cells[i] != 0 ? 0 : distance + 1;
    squares[i] = distance;
  }
  distance = walls ? 0 : kInfinity;
  for (int i = length - 1; i >= 0; --i) {
    distance = cells[i] != 0 ? 0 : distance + 1;
    const float nearest = std::min(squares[i], distance);
    squares[i] = nearest * nearest;
  }
}

}  // namespace

DistanceFieldBuilder::DistanceFieldBuilder(const VoxelSettings& settings)
    : grid_(settings), walls_(settings.walls) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    field_.origin[axis] = static_cast<float>(settings.lower[static_cast<Eigen::Index>(axis)]);
  }
  field_.resolution = static_cast<float>(settings.resolution_m);
  field_.size = grid_.size();
  field_.outside = walls_ ? 0 : kInfinity;
  field_.values.resize(grid_.cells().size());
}

const DistanceField& DistanceFieldBuilder::Rebuild(const Scene& scene) {
  grid_.Clear();
  grid_.Mark(scene);
  return Transform(grid_.cells());
}

const DistanceField& DistanceFieldBuilder::Transform(const std::vector<std::uint8_t>& cells) {
  if (cells.size() != field_.values.size()) {
    throw std::invalid_argument("Transform: not one value a cell");
  }
  const auto [size_x, size_y, size_z] = field_.size;
  const auto row = static_cast<std::size_t>(size_x);
  const std::size_t slab = row * static_cast<std::size_t>(size_y);
  float* const values = field_.values.data();

  LinePass along_y(size_y, walls_);
  for (int z = 0; z < size_z; ++z) {
    const std::size_t start = static_cast<std::size_t>(z) * slab;
    for (std::size_t at = start; at < start + slab; at += row) {
      PassX(&cells[at], size_x, walls_, values + at);
    }
    for (int x = 0; x < size_x; x += kLines) {
      float* const at = values + start + x;
      along_y.Run(at, row, std::min(kLines, size_x - x));
    }
  }
  LinePass along_z(size_z, walls_);
  for (std::size_t at = 0; at < slab; at += kLines) {
    along_z.Run(values + at, slab, static_cast<int>(std::min<std::size_t>(kLines, slab - at)));
  }
  for (float& value : field_.values) value = field_.resolution * std::sqrt(value);
  return field_;
}

}  // namespace planbench
