#pragma once

namespace heliograph::render::kernels {

/// A reference to a callable `void(int first, int last)`, which must outlive it.
class RangeWork {
 public:
  template <class Work>
  RangeWork(const Work& work)
      : work_(&work), call_([](const void* object, int first, int last) {
          (*static_cast<const Work*>(object))(first, last);
        }) {}

  void operator()(int first, int last) const { call_(work_, first, last); }

 private:
  const void* work_;
  void (*call_)(const void*, int, int);
};

/// Calls `work(first, last)` for ranges of `grain` of the items 0 to `count`, on all processors.
/// Not a template: the headers of TBB take longer to compile than most kernels.
void for_each_range(int count, int grain, RangeWork work);

/// How many of them there are for this process.
int processors();

}  // namespace heliograph::render::kernels
