// How a plan runs a frame.

#include <algorithm>
#include <chrono>
#include <utility>

#include "gpu/frame_plan/frame_plan_parts.hpp"

namespace heliograph::gpu {
namespace {

using Clock = std::chrono::steady_clock;

/// Timers keep passes from running at the same time, so that few frames have them.
constexpr std::uint32_t timed_frame_interval = 16;
/// The device begins with so many passes while the others are recorded, unless it works on the
/// frame before: every submit costs it time.
constexpr std::size_t passes_submitted_first = 8;

float since(Clock::time_point start) {
  return std::chrono::duration<float, std::milli>(Clock::now() - start).count();
}

std::uint32_t groups(std::uint32_t threads, std::uint32_t local_size) {
  return (threads + local_size - 1) / local_size;
}

}  // namespace

bool FramePlan::timed_by_clock() const {
  return device_.is_cpu();
}

bool FramePlan::execute(const std::function<bool()>& canceled) {
  if (!begin(canceled)) return false;
  finish();
  return true;
}

bool FramePlan::begin(const std::function<bool()>& canceled) {
  if (!compiled_) throw GpuError("a frame plan runs only after compile()");
  if (begun_.size() > 1 || (begun_.size() == 1 && !in_flight())) {
    throw GpuError("a frame begins before the one before it is finished");
  }
  device_.check_presence();
  choose_timing();
  in_a_crowd_ = device_.queues().is_crowded();
  submits_ = 0;
  recording_ = false;
  canceled_ = false;
  // Where passes are timed by the clock, nothing is recorded that was not submitted.
  asks_canceled_ = canceled && timed_by_clock() ? &canceled : nullptr;
  ++frame_;
  // Without early passes, two frames run one after the other on one queue.
  const bool overlaps = !begun_.empty() && parts_.early > 0;
  if (begun_.empty() || overlaps) queue_ = choose_queue();
  closed_.reset();
  if (overlaps) {
    const Begun& before = begun_.front();
    wait_first_ = before.timed ? before.submitted : before.closed;  // passes are timed alone
  }
  const bool finished = run_passes();
  asks_canceled_ = nullptr;
  if (!finished) return false;
  const Readback& readback = readbacks_[parity_];
  const bool comes_back = readback && (!read_back_when_ || read_back_when_());
  if (comes_back && readback.copies()) readback.record(recorder(), get(read_back_));
  submit();
  const auto last = std::exchange(submitted_, std::nullopt);
  begun_.push_back({.submitted = last,
                    .closed = closed_ ? closed_ : last,
                    .frame = frame_,
                    .slot = parity_,
                    .follows = overlaps,
                    .came_back = comes_back,
                    .timed = times_passes_});
  parity_ ^= 1;
  return true;
}

std::uint32_t FramePlan::choose_queue() const {
  return draws_ ? Queues::general : device_.queues().idlest_compute();
}

bool FramePlan::can_begin_another() const {
  return begun_.size() == 1 && in_flight() && frames_since_timed_ < timed_frame_interval;
}

float FramePlan::part_before_next() const {
  if (parts_.early == 0 || begun_.empty() || begun_.front().timed) return 1.0f;
  // On one queue frames run one after the other.
  if (draws_ || device_.queues().compute_count() < 2) return 1.0f;
  const float start = time_of(0, parts_.early), end = time_of(parts_.closed, passes_.size());
  const float between = time_of(parts_.early, parts_.closed);
  const float all = start + between + end;
  if (all <= 0.0f) return 1.0f;
  // The end of the frame before has hidden as much of the start.
  return (between + (begun_.front().follows ? std::max(start - end, 0.0f) : start)) / all;
}

/// Milliseconds, of the passes at these places of the order that ran.
float FramePlan::time_of(std::size_t first, std::size_t last) const {
  float all = 0.0f;
  for (std::size_t place = first; place < last; ++place) {
    all += std::max(timings_[order_.passes[place]].milliseconds, 0.0f);
  }
  return all;
}

void FramePlan::finish() {
  if (begun_.empty()) throw GpuError("a frame is finished that has not begun");
  const Begun begun = begun_.front();
  begun_.pop_front();
  if (begun.submitted) device_.wait(*begun.submitted);
  if (begun.timed) read_timers();
  finished_ = begun.slot;
  finished_frame_ = begun.frame;
  came_back_ = begun.came_back;
}

bool FramePlan::wait_for(std::chrono::nanoseconds time) const {
  return !in_flight() || device_.queues().wait_for(*begun_.front().submitted, time);
}

/// Or a pass runs that was never timed.
bool FramePlan::timing_is_due() const {
  if (frames_since_timed_ >= timed_frame_interval) return true;
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    const Pass& pass = passes_[i];
    if (measured_[i] < 0.0f && pass.program && (!pass.condition || pass.condition())) return true;
  }
  return false;
}

/// Of the frame that begins. Timers are for one frame at a time.
void FramePlan::choose_timing() {
  times_passes_ = !timed_by_clock() && begun_.empty() && timing_is_due();
  ++frames_since_timed_;
  if (!times_passes_) return;
  frames_since_timed_ = 1;
  vkResetQueryPool(device_.handle(), queries_, 0, static_cast<std::uint32_t>(passes_.size() * 2));
}

bool FramePlan::is_canceled() const {
  if (canceled_) return true;
  if (!asks_canceled_) return false;
  // One thread that asks is enough.
  const std::unique_lock lock(asking_, std::try_to_lock);
  if (lock && (*asks_canceled_)()) canceled_ = true;
  return canceled_;
}

/// Whether none of them was canceled.
bool FramePlan::run_passes() {
  // The frame before, or work of another queue, may have written what this one reads. Later: of
  // passes left out, since those behind them rely on it.
  bool barrier = !timed_by_clock();
  std::size_t recorded = 0;
  for (std::size_t place = 0; place < order_.passes.size(); ++place) {
    if (parts_.early > 0) submit_parts(place);
    const std::uint32_t i = order_.passes[place];
    const Pass& pass = passes_[i];
    if (i >= cancelable_) asks_canceled_ = nullptr;
    if (is_canceled()) return false;
    barrier |= order_.barrier_before[i];
    if (pass.condition && !pass.condition()) {
      timings_[i].milliseconds = -1.0f;  // not run
      barrier |= !pass.program;
      continue;
    }
    for (const std::uint32_t index : pass.doubled) resources_[index].written[parity_] = frame_;
    const bool on_host = pass.runs_on_host();
    timings_[i].host = on_host;
    const auto start = Clock::now();
    if (!on_host) {
      // A pass is timed alone.
      if (std::exchange(barrier, false) || times_passes_) full_barrier(recorder());
      record(pass, recorder(), i * 2);
      if (!timed_by_clock()) {
        timings_[i].milliseconds = measured_[i];
        if (++recorded == passes_submitted_first && begun_.empty()) submit();
        continue;
      }
    }
    flush();
    if (!on_host) {
      timings_[i].milliseconds = since(start);
      continue;
    }
    const auto begun = Clock::now();
    if (pass.kernel) {
      run_host_kernel(pass);
    } else {
      pass.host();
    }
    timings_[i].milliseconds = since(begun);
  }
  return !canceled_;
}

/// In front of the pass at this place of the order: what was recorded, where the frame is divided.
void FramePlan::submit_parts(std::size_t place) {
  if (place == parts_.early) {
    submit();
    if (!begun_.empty()) wait_first_ = begun_.front().submitted;
  }
  if (place == parts_.closed) {
    submit();
    closed_ = submitted_;
  }
}

void FramePlan::run_host_kernel(const Pass& pass) const {
  std::array<HostView, most_bindings> views{};
  for (std::size_t i = 0; i < pass.listed.size(); ++i) {
    const std::uint32_t index = pass.listed[i].resource;
    if (index == ImageRef().index) continue;
    const Resource& resource = resources_[index];
    const Buffer* const buffer = resource.buffers[parity_];
    views[i] =
        buffer ? HostView{buffer->mapped(), buffer->size()} : resource.images[parity_]->host();
  }
  std::array<std::byte, most_constants> constants;
  if (pass.constants) pass.constants(constants.data());
  pass.kernel(std::span(views).first(pass.listed.size()),
              std::span(constants).first(pass.constants_size),
              FrameSize::squares(pass.side).of(drawn_));
}

VkCommandBuffer FramePlan::recorder() {
  const VkCommandBuffer commands = frame_commands(submits_);
  if (std::exchange(recording_, true)) return commands;
  VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &info), "begin the frame's commands");
  return commands;
}

void FramePlan::flush() {
  submit();
  wait();
}

void FramePlan::wait() {
  if (const auto submitted = std::exchange(submitted_, std::nullopt)) device_.wait(*submitted);
}

void FramePlan::submit() {
  if (!std::exchange(recording_, false)) return;
  const VkCommandBuffer commands = frame_commands(submits_++);
  // Mapped memory is read after this submit, by a host pass or by the caller that takes the frame.
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT;
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
  check(vkEndCommandBuffer(commands), "end the frame's commands");
  submitted_ = device_.submit(commands, queue_, std::exchange(wait_first_, std::nullopt));
}

void FramePlan::record(const Pass& pass, VkCommandBuffer commands, std::uint32_t query) {
  if (device_.labels()) {
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = pass.name.c_str();
    vkCmdBeginDebugUtilsLabelEXT(commands, &label);
  }
  if (times_passes_) {
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, query);
  }
  if (pass.is_raster) {
    record_raster(pass, commands);
  } else {
    bind(pass, commands);
    const VkExtent2D threads = pass.threads.of(drawn_);
    if (pass.rays) {
      pass.rays->launch(commands, threads.width);
    } else if (pass.indirect) {
      vkCmdDispatchIndirect(commands, get(BufferRef{pass.indirect->first}).handle(),
                            pass.indirect->second);
    } else {
      vkCmdDispatch(commands, groups(threads.width, pass.local_size.width),
                    groups(threads.height, pass.local_size.height), pass.layers);
    }
  }
  if (times_passes_) {
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, query + 1);
  }
  if (device_.labels()) vkCmdEndDebugUtilsLabelEXT(commands);
}

const Program& FramePlan::program_of(const Pass& pass) const {
  return in_a_crowd_ && pass.in_a_crowd ? *pass.in_a_crowd : *pass.program;
}

void FramePlan::bind(const Pass& pass, VkCommandBuffer commands) {
  const VkPipelineBindPoint point = pass.bind_point();
  const Program& program = program_of(pass);
  const VkPipelineLayout layout = program.layout();
  vkCmdBindPipeline(commands, point, program.pipeline());
  bind_shared_sets(pass, commands);
  if (pass.sets[parity_]) {
    vkCmdBindDescriptorSets(commands, point, layout, pass_set, 1, &pass.sets[parity_], 0, nullptr);
  }
  if (pass.constants) {
    std::array<std::byte, most_constants> bytes;
    pass.constants(bytes.data());
    vkCmdPushConstants(commands, layout, program.stages(), 0,
                       static_cast<std::uint32_t>(pass.constants_size), bytes.data());
  }
}

void FramePlan::bind_shared_sets(const Pass& pass, VkCommandBuffer commands) {
  const Program& program = program_of(pass);
  for (const SharedSet& shared : shared_sets_) {
    if (!program.uses_set(shared.number)) continue;
    const bool replaced = std::ranges::any_of(shared_sets_, [&](const SharedSet& other) {
      return other.number == shared.number && other.side == pass.side;
    });
    if (replaced ? shared.side != pass.side : shared.side != 1) continue;
    vkCmdBindDescriptorSets(commands, pass.bind_point(), program.layout(), shared.number, 1,
                            &shared.sets[parity_], 0, nullptr);
  }
}

void FramePlan::record_raster(const Pass& pass, VkCommandBuffer commands) {
  const auto attachment = [&](const Pass::Attachment& from) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = physical(from.resource, parity_).view();
    info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.loadOp = from.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    if (from.clear) std::memcpy(&info.clearValue, from.clear->data(), sizeof(float) * 4);
    return info;
  };
  std::vector<VkRenderingAttachmentInfo> colors;
  for (const auto& color : pass.colors) colors.push_back(attachment(color));
  VkRenderingAttachmentInfo depth{};
  if (pass.depth) depth = attachment(*pass.depth);
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = {{0, 0}, drawn_};
  info.layerCount = 1;
  info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  info.pColorAttachments = colors.data();
  info.pDepthAttachment = pass.depth ? &depth : nullptr;
  vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(drawn_.width), static_cast<float>(drawn_.height), 0.0f, 1.0f};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &info.renderArea);
  bind(pass, commands);
  pass.draw(commands, pass.program->layout());
  vkCmdEndRendering(commands);
}

void FramePlan::read_timers() {
  const float period = device_.limits().timestampPeriod * 1e-6f;
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    if (!passes_[i].program) continue;
    std::array<std::uint64_t, 2> times{};
    const VkResult result = vkGetQueryPoolResults(
        device_.handle(), queries_, static_cast<std::uint32_t>(i * 2), 2, sizeof times,
        times.data(), sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT);
    if (result == VK_SUCCESS) {
      measured_[i] = static_cast<float>(times[1] - times[0]) * period;
      timings_[i].milliseconds = measured_[i];
    }
  }
}

}  // namespace heliograph::gpu
