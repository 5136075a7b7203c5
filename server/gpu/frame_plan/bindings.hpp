#pragma once

// The resources of a pass in one list, from which the shader's bindings and what the host kernel
// sees follow. A list is a struct template whose members stand in the order of the shader's
// bindings:
//
//   template <class Stage>
//   struct BlurBindings {
//     gpu::Read<Stage> guide, signal;
//     gpu::Write<Stage> blurred;
//   };
//
// BlurBindings<gpu::Declared> is filled where the pass is declared, with handles of the plan;
// BlurBindings<gpu::Mapped> is what the kernel gets: the same members as memory of the host.

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

#include "gpu/memory/image.hpp"

namespace heliograph::gpu {

/// Handles of a plan's resources; cheap to copy, valid as long as the plan.
struct ImageRef {
  std::uint32_t index = ~0u;
};
struct BufferRef {
  std::uint32_t index = ~0u;
};

enum class Access : std::uint32_t { read = 1, write = 2, read_write = 3 };

/// One resource of a pass and what the pass does with it.
struct Use {
  std::uint32_t resource;  // ~0u: the shader has no such binding
  Access access;
};

template <Access kind>
struct ImageUse : Use {
  ImageUse(ImageRef image) : Use{image.index, kind} {}
};
template <Access kind>
struct OptionalImageUse : Use {
  OptionalImageUse(std::optional<ImageRef> image) : Use{image.value_or(ImageRef()).index, kind} {}
};
template <Access kind>
struct BufferUse : Use {
  BufferUse(BufferRef buffer) : Use{buffer.index, kind} {}
};
template <Access kind>
struct OptionalBufferUse : Use {
  OptionalBufferUse(std::optional<BufferRef> buffer)
      : Use{buffer.value_or(BufferRef()).index, kind} {}
};

/// A buffer's contents in the host's memory.
template <typename Element>
struct HostBuffer {
  Element* data;
  std::size_t bytes;
  operator Element*() const { return data; }
  Element* operator->() const { return data; }
};

struct Declared {
  template <Access access>
  using Image = ImageUse<access>;
  template <Access access>
  using OptionalImage = OptionalImageUse<access>;
  template <Access access, typename Element>
  using Buffer = BufferUse<access>;
  template <Access access, typename Element>
  using OptionalBuffer = OptionalBufferUse<access>;
};

/// Images without memory of the host, and what is absent, have no data.
struct Mapped {
  template <Access access>
  using Image = HostView;
  template <Access access>
  using OptionalImage = HostView;
  template <Access access, typename Element>
  using Buffer = HostBuffer<Element>;
  template <Access access, typename Element>
  using OptionalBuffer = HostBuffer<Element>;
};

template <class Stage>
using Read = typename Stage::template Image<Access::read>;
template <class Stage>
using Write = typename Stage::template Image<Access::write>;
template <class Stage>
using ReadWrite = typename Stage::template Image<Access::read_write>;
template <class Stage>
using OptionalRead = typename Stage::template OptionalImage<Access::read>;
template <class Stage>
using OptionalWrite = typename Stage::template OptionalImage<Access::write>;
template <class Stage, typename Element>
using ReadBuffer = typename Stage::template Buffer<Access::read, const Element>;
template <class Stage, typename Element>
using WriteBuffer = typename Stage::template Buffer<Access::write, Element>;
template <class Stage, typename Element>
using ReadWriteBuffer = typename Stage::template Buffer<Access::read_write, Element>;
template <class Stage, typename Element>
using OptionalWriteBuffer = typename Stage::template OptionalBuffer<Access::write, Element>;
template <class Stage, typename Element>
using OptionalReadWriteBuffer =
    typename Stage::template OptionalBuffer<Access::read_write, Element>;

/// How many resources a list has.
template <template <class> class Bindings>
inline constexpr std::size_t binding_count = sizeof(Bindings<Declared>) / sizeof(Use);

template <template <class> class Bindings>
using HostViews = std::array<HostView, binding_count<Bindings>>;

/// The members of a list in order.
template <template <class> class Bindings>
std::array<Use, binding_count<Bindings>> uses_of(const Bindings<Declared>& bindings) {
  return std::bit_cast<std::array<Use, binding_count<Bindings>>>(bindings);
}

/// Names what lies in `views`, which are in the list's order.
template <template <class> class Bindings>
Bindings<Mapped> map_bindings(const HostViews<Bindings>& views) {
  static_assert(sizeof(HostBuffer<std::byte>) == sizeof(HostView));
  return std::bit_cast<Bindings<Mapped>>(views);
}

/// Its address identifies a list.
template <template <class> class Bindings>
inline constexpr char bindings_tag = 0;

struct NoConstants {};

/// What a host kernel gets of its pass: the resources, the push constants of this frame and the
/// size that it is drawn at, pixels.
template <template <class> class List, class ConstantsType = NoConstants>
struct HostPass : List<Mapped> {
  using Pass = HostPass;
  ConstantsType constants;
  int width;
  int height;
};

}  // namespace heliograph::gpu
