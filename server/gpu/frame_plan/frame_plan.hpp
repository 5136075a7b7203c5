#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/frame_plan/bindings.hpp"
#include "gpu/frame_plan/frame_overlap.hpp"
#include "gpu/frame_plan/pass_builder.hpp"
#include "gpu/memory/readback.hpp"
#include "gpu/pipelines/ray_pipeline.hpp"
#include "gpu/pipelines/shader.hpp"

namespace heliograph::gpu {

/// A signal with a history: what this frame writes is what the next frame reads.
struct History {
  ImageRef current;
  ImageRef previous;
};

/// What a pass had to touch: every image that it reads or writes counted whole, once for each, and
/// the entries of the stream it works on, whose count lies at the start of a buffer.
struct PassWork {
  std::string name;
  std::uint64_t image_bytes = 0;
  std::uint64_t entries = 0;
};

struct PassTiming {
  std::string name;
  bool host = false;
  float milliseconds = 0.0f;
};

/// A compute program that is made when a plan needs it: not where a host kernel does the work.
using ProgramSource = std::function<const ComputeProgram&()>;

struct Lifetime;

/// An ordered list of passes with what each reads and writes, from which barriers, timestamps,
/// labels, descriptor sets, the list of views and the history swap follow. Passes run in the order
/// declared on devices that are processors; others work on all passes at a time that need nothing
/// of each other, also on those at the end of one frame and at the start of the next
/// (overlap_frames). Images stay in GENERAL. A host pass runs on the processor after everything
/// before it is done; on a CPU device it sees images and buffers through their mapping. Work goes
/// to the device when a host pass or the caller waits for it: a frame of host passes alone submits
/// nothing.
class FramePlan {
 public:
  FramePlan(const Device& device, VkExtent2D extent);
  ~FramePlan();
  FramePlan(const FramePlan&) = delete;
  FramePlan& operator=(const FramePlan&) = delete;

  /// The size of frames.
  VkExtent2D extent() const { return extent_; }
  /// The size that they are drawn at: that one, unless set_drawn() reduced it.
  VkExtent2D drawn() const { return drawn_; }
  /// The same of an image.
  VkExtent2D drawn(ImageRef image) const;
  /// Images that follow the frame are used from the first texel to this size from the next frame
  /// on. Histories among them are scaled to it. At most extent(). Waits.
  void set_drawn(VkExtent2D drawn);
  const Device& device() const { return device_; }

  /// Whether passes declared from now on run their host kernels, where they have one. Only devices
  /// that are processors do.
  void use_host_kernels(bool use) { host_kernels_ = use && device_.is_cpu(); }
  bool uses_host_kernels() const { return host_kernels_; }

  /// Resources declared from now on lie in few blocks of memory, which they share on devices that
  /// are processors where no pass needs both. They do not exist before compile(). Images and
  /// buffers of Memory::device keep their content for as long as passes read them; histories, and
  /// images for keep(), until the next frame begins. A history that only passes under a condition
  /// write has no defined content after frames without them.
  void share_memory() {
    makes_later_ = true;
    shares_memory_ = device_.is_cpu();
  }
  /// Before compile(): an image that can be read after every frame.
  void keep(ImageRef image) { kept_.push_back(image.index); }
  /// Before compile(): an image of whose content no pass makes use in frames that skip those that
  /// write it, nor the next frame of a history's. It is not defined then, unless images are kept.
  void leave_undefined_when_skipped(ImageRef image) {
    undefined_when_skipped_.push_back(image.index);
  }
  /// Before compile(): an image whose content does not matter in frames that skip those that write
  /// it, although other passes may read it.
  void ignore_when_skipped(ImageRef image) { ignored_when_skipped_.push_back(image.index); }
  /// From the next frame on all images keep their content until another frame begins, and what
  /// passes left out, instead of only those for keep(): more memory, in which histories stay.
  void keep_images(bool keep);
  bool keeps_images() const { return keeps_images_ || !shares_memory_; }
  /// Whether the image can be read after a frame.
  bool holds(ImageRef image) const;
  bool is_history(ImageRef image) const;
  /// A frame that has come to the passes declared from now on is not canceled any more. Of what
  /// shares memory, they may take that of the frame before's histories.
  void finish_frames_from_here();

  /// An image; mapped on CPU devices.
  ImageRef image(std::string_view name, VkFormat format, VkImageUsageFlags extra_usage = 0,
                 FrameSize size = each_pixel());
  /// Two images that swap after every frame; cleared to zero.
  History history(std::string_view name, VkFormat format, VkImageUsageFlags extra_usage = 0,
                  FrameSize size = each_pixel());
  BufferRef buffer(std::string name, VkDeviceSize size, VkBufferUsageFlags usage, Memory memory);
  /// A buffer that each frame writes for the host, which reads it as latest() after finish(), also
  /// while the device works on another frame.
  BufferRef returned(std::string name, VkDeviceSize size, VkBufferUsageFlags usage);
  /// Resources owned elsewhere, which must outlive the plan.
  BufferRef import(const Buffer& buffer);
  /// The whole image for sampling (`level` absent, with `sampler`) or one level for storage.
  ImageRef import(const Image& image, std::optional<std::uint32_t> level, VkSampler sampler);

  /// A descriptor set of the caller's for every program that declares set `number`, of passes that
  /// are reduced() by `side`, or of all that no other set is for. `sets`: one for each slot().
  void share_set(std::uint32_t number, const std::array<VkDescriptorSet, 2>& sets,
                 std::uint32_t side = 1);
  void share_set(std::uint32_t number, VkDescriptorSet set, std::uint32_t side = 1) {
    share_set(number, {set, set}, side);
  }
  /// Of the frame that begins next: what the host writes for a frame is there for each of two,
  /// since the device may still work on the one before.
  std::uint32_t slot() const { return parity_; }

  PassBuilder pass(std::string name, const ComputeProgram& program);
  PassBuilder pass(std::string name, ProgramSource program);
  PassBuilder pass(std::string name, const RayProgram& program);
  PassBuilder raster(std::string name, const RasterProgram& program);
  /// A pass without a shader. One that is given host() besides runs that instead of `run`.
  PassBuilder host(std::string name, std::function<void()> run);

  /// Passes that `declare` adds are skipped in frames where `condition` is false, besides what
  /// their own when() says; those that `otherwise` adds where it is true. What both write is
  /// written in every frame. Without a condition `declare` alone counts.
  void only_when(const std::function<bool()>& condition, const std::function<void()>& declare,
                 const std::function<void()>& otherwise = {});

  /// Of images and passes that `declare` adds, sizes that follow the frame are those of a frame
  /// with one texel for each square of `side` by `side` pixels.
  void reduced(std::uint32_t side, const std::function<void()>& declare);

  /// The one image that comes back to the host with every frame, or with those where `when` is
  /// true, through read().
  void read_back(ImageRef image, std::function<bool()> when = {}) {
    read_back_ = image;
    read_back_when_ = std::move(when);
    keep(image);
  }

  /// Checks every pass against its shader and derives everything else; call once after the last
  /// pass. @throws GpuError naming pass, binding and what is wrong
  void compile();

  /// Runs all passes, waits for them, reads the timers and swaps the histories. `canceled` is asked
  /// before each pass on CPU devices, up to finish_frames_from_here(), and by long passes while
  /// they run, from any thread but never from two at once; where it returns true, the result is
  /// false, the remaining passes do not run and histories do not swap. Images have no defined
  /// content then.
  bool execute(const std::function<bool()>& canceled = {});
  /// The first part of execute(): runs the passes of the host and gives the device its work. Until
  /// finish() nothing of the plan changes and nothing is read.
  bool begin(const std::function<bool()>& canceled = {});
  /// Whether begin() may be called before finish(): where the device works on one frame, and the
  /// next is not one of those that are timed. What the device reads, the host may not change then,
  /// but for what is there for each slot().
  bool can_begin_another() const;
  /// The part of its time after which the device can work on another frame beside the one that has
  /// begun first, from when the frame before that was done; 1: not before its end.
  float part_before_next() const;
  /// The second part: waits for the device to finish the frame that has begun first.
  void finish();
  /// Whether the device may still work on a frame that has begun.
  bool in_flight() const { return !begun_.empty() && begun_.front().submitted; }
  /// Waits for the frame that has begun first, but no longer. @returns whether it is done
  bool wait_for(std::chrono::nanoseconds time) const;
  /// Whether the frame that runs is canceled: what a pass writes is not read any more. Thread safe.
  bool is_canceled() const;
  /// The frame that just ran, as read_back() asked for it: level 0, rows tightly packed. Where it
  /// did not come back by itself, the device copies it now.
  std::vector<std::uint8_t> read();
  /// Of every pass, in the order declared; below 0 where it did not run. Devices that overlap
  /// passes run them one after the other where they are timed: in one of sixteen frames, and where
  /// a pass runs that was never timed. In frames between, the times are the newest of each pass,
  /// also if it runs another shader then (PassBuilder::in_a_crowd).
  const std::vector<PassTiming>& timings() const { return timings_; }
  /// The work behind the timings of the frame that just ran, in the same order. Copies counts back
  /// from the device: for measurements, not for every frame.
  std::vector<PassWork> work() const;

  const Image& get(ImageRef image) const;  // this frame's image of a history
  const Buffer& get(BufferRef buffer) const;
  /// The image written by the frame that was finished last; of those that frames have in turn the
  /// newest that a finished frame has written.
  const Image& latest(ImageRef image) const;
  /// Likewise of returned().
  const Buffer& latest(BufferRef buffer) const;

  struct View {
    std::string name;
    ImageRef image;
  };
  const std::vector<View>& views() const { return views_; }

  void reset(const History& history);

  /// Bytes of all images and buffers that the plan owns.
  std::uint64_t memory_bytes() const;

  /// Names of passes in front of which a barrier stands, in order: what the tests look at.
  std::vector<std::string> barriers() const;
  /// How often the frame that just ran submitted work to the device: not at all where every pass
  /// ran on the host.
  std::size_t submits() const { return submits_; }

 private:
  friend class PassBuilder;
  struct Resource;
  struct Pass;

  std::uint32_t add(Resource resource);
  /// Makes what a resource describes: with its own memory, or in its places of blocks in even and
  /// in odd frames.
  void make(Resource& resource, const std::array<MemoryPlace, 2>& places) const;
  /// The history whose `current` has this index, likewise; zeroed.
  void make_history(std::uint32_t current, const std::array<MemoryPlace, 2>& places);
  /// What is left to make.
  void make_histories();
  /// Where memory is not shared.
  void make_in_blocks();
  void make_resources();
  void release_shared();
  /// Absent for what needs memory of its own.
  std::optional<Lifetime> shared_lifetime(std::uint32_t index) const;
  Lifetime history_lifetime(std::uint32_t index) const;
  struct Uses {
    std::uint32_t first, last;  // passes
    Access first_access;
  };
  std::optional<Uses> first_and_last_use(std::uint32_t index) const;
  std::uint32_t new_condition() { return 2 * conditions_++; }
  static std::uint32_t opposite_condition(std::uint32_t condition) { return condition ^ 1; }
  /// Those without which no pass of a frame writes the resource.
  std::vector<std::uint32_t> conditions_of_writing(std::uint32_t index) const;
  /// Whether frames may leave out the passes that write the resource; whether they may do so and
  /// run another pass that uses it.
  bool leaves_out(std::uint32_t index) const;
  bool is_undefined_when_skipped(std::uint32_t index) const;
  bool reads_left_out(std::uint32_t index) const;
  PassBuilder add(Pass pass);
  bool run_passes();
  void run_host_kernel(const Pass& pass) const;
  void check_pass(const Pass& pass) const;
  void make_programs();
  void order_passes();
  /// By number.
  std::vector<FrameResource> frame_resources() const;
  /// As declared; what is imported twice is one resource.
  std::vector<PassUses> pass_uses() const;
  bool can_be_doubled(std::uint32_t index) const;
  /// Of the newest finished frame that has written it.
  std::uint32_t slot_of_latest(const Resource& resource) const;
  float time_of(std::size_t first, std::size_t last) const;
  void make_descriptor_sets();
  void make_command_buffers();
  /// For the frame that begins: always of one family.
  std::uint32_t choose_queue() const;
  void list_views();
  void record(const Pass& pass, VkCommandBuffer commands, std::uint32_t query);
  void record_raster(const Pass& pass, VkCommandBuffer commands);
  void bind(const Pass& pass, VkCommandBuffer commands);
  /// What runs in this frame.
  const Program& program_of(const Pass& pass) const;
  void bind_shared_sets(const Pass& pass, VkCommandBuffer commands);
  /// Whether every pass is a submit of its own, timed from outside: drivers for processors write
  /// timestamps while they record, as soon as anything was ever drawn.
  bool timed_by_clock() const;
  VkCommandBuffer frame_commands(std::size_t submit) const {
    return commands_[parity_ * (commands_.size() / 2) + submit];
  }
  /// The command buffer of what comes next, begun with its first command.
  VkCommandBuffer recorder();
  /// Gives the device what was recorded since the last submit, if anything.
  void submit();
  void submit_parts(std::size_t place);
  /// For all that was submitted.
  void wait();
  void flush();  // both
  bool timing_is_due() const;
  void choose_timing();
  void read_timers();
  const Image& physical(std::uint32_t index, std::uint32_t parity) const;
  VkImageView physical_view(std::uint32_t index, std::uint32_t parity) const;

  const Device& device_;
  VkExtent2D extent_;
  VkExtent2D drawn_;
  std::vector<Resource> resources_;
  std::vector<Pass> passes_;  // as declared
  PassOrder order_;           // in which they run
  FrameParts parts_;
  struct SharedSet {
    std::uint32_t number;
    std::uint32_t side;
    std::array<VkDescriptorSet, 2> sets;  // by slot()
  };
  std::vector<SharedSet> shared_sets_;
  std::uint32_t side_ = 1;  // of the squares that what is declared now has one texel for
  std::unique_ptr<DescriptorPool> descriptor_pool_;
  Sampler default_sampler_;
  ImageRef read_back_;
  std::function<bool()> read_back_when_;   // empty: in every frame
  std::array<Readback, 2> readbacks_;      // by slot()
  bool came_back_ = false;                 // with the frame that was finished last
  bool draws_ = false;                     // triangles, which queues for compute alone cannot
  std::uint32_t queue_ = Queues::general;  // of the frames that have begun
  VkCommandPool command_pool_ = VK_NULL_HANDLE;
  std::vector<VkCommandBuffer> commands_;  // one for each submit of a frame, slot by slot
  bool in_a_crowd_ = false;                // the frame that has begun last, when it began
  std::size_t submits_ = 0;                // of this frame so far
  bool recording_ = false;                 // into the next
  std::optional<Submission> submitted_;    // what was last submitted and not waited for
  std::optional<Submission> wait_first_;   // of the frame before, by the next submit
  std::optional<Submission> closed_;       // of this frame, as Begun has it
  std::uint64_t frame_ = 0;                // number of the frame that has begun last, from 1
  std::uint64_t finished_frame_ = 0;       // of the one that was finished last
  /// A frame that has begun.
  struct Begun {
    std::optional<Submission> submitted;  // its last work for the device
    std::optional<Submission> closed;     // behind it the next frame may begin
    std::uint64_t frame = 0;              // its number
    std::uint32_t slot = 0;
    bool follows = false;  // its early passes ran beside the frame before
    bool came_back = false;
    bool timed = false;
  };
  std::deque<Begun> begun_;     // at most two, the older one first
  std::uint32_t finished_ = 1;  // slot of the frame that was finished last
  VkQueryPool queries_ = VK_NULL_HANDLE;
  bool times_passes_ = false;    // by queries, in the frame that runs
  std::vector<float> measured_;  // milliseconds by pass when it was last timed; below 0: never
  std::uint32_t frames_since_timed_ = 0;
  std::vector<PassTiming> timings_;
  std::vector<View> views_;
  /// The two blocks of all histories, which change parts after every frame; null where histories
  /// have memory of their own.
  std::array<std::shared_ptr<const MemoryBlock>, 2> history_blocks_;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> history_offsets_;  // of `current` ones
  std::vector<std::uint32_t> kept_;
  std::vector<std::uint32_t> undefined_when_skipped_;
  std::vector<std::uint32_t> ignored_when_skipped_;
  std::uint32_t conditions_ = 0;                          // of passes, made so far
  const std::function<bool()>* asks_canceled_ = nullptr;  // while a frame may be canceled
  mutable std::mutex asking_;
  mutable std::atomic<bool> canceled_ = false;  // the frame that runs
  std::size_t cancelable_ = ~std::size_t{0};    // passes in front of which a frame may be canceled
  bool keeps_images_ = false;
  std::uint32_t parity_ = 0;
  bool host_kernels_ = false;
  bool makes_later_ = false;  // resources: not before compile()
  bool shares_memory_ = false;
  VkCommandBuffer setup_ = VK_NULL_HANDLE;  // of images that are being made; null: each of its own
  bool compiled_ = false;
};

}  // namespace heliograph::gpu
