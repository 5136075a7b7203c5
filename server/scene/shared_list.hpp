#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace heliograph::scene {

/// A list whose copies share their elements, so that two scenes can have the same geometry. What
/// changes an element or the length of a shared one copies it first: only the owner of the one copy
/// that there is may do so beside other threads. Otherwise like std::vector.
template <class Element>
class SharedList {
 public:
  using List = std::vector<Element>;
  using value_type = Element;
  using iterator = typename List::iterator;
  using const_iterator = typename List::const_iterator;

  SharedList() = default;
  SharedList(List elements) : list_(std::make_shared<List>(std::move(elements))) {}
  SharedList(std::initializer_list<Element> elements) : SharedList(List(elements)) {}
  SharedList& operator=(std::initializer_list<Element> elements) {
    list_ = std::make_shared<List>(elements);
    return *this;
  }

  operator const List&() const { return get(); }
  std::size_t size() const { return get().size(); }
  bool empty() const { return get().empty(); }
  const_iterator begin() const { return get().begin(); }
  const_iterator end() const { return get().end(); }
  const Element& operator[](std::size_t i) const { return get()[i]; }
  const Element& at(std::size_t i) const { return get().at(i); }
  const Element& front() const { return get().front(); }
  const Element& back() const { return get().back(); }
  /// Whether both have the very same elements in memory.
  bool shares_with(const SharedList& other) const { return list_ && list_ == other.list_; }

  iterator begin() { return own().begin(); }
  iterator end() { return own().end(); }
  Element& operator[](std::size_t i) { return own()[i]; }
  Element& at(std::size_t i) { return own().at(i); }
  Element& front() { return own().front(); }
  Element& back() { return own().back(); }
  void push_back(Element element) { own().push_back(std::move(element)); }
  template <class... Arguments>
  Element& emplace_back(Arguments&&... arguments) {
    return own().emplace_back(std::forward<Arguments>(arguments)...);
  }
  void resize(std::size_t count) { own().resize(count); }

 private:
  const List& get() const {
    static const List none;
    return list_ ? *list_ : none;
  }
  List& own() {
    if (!list_) list_ = std::make_shared<List>();
    if (list_.use_count() > 1) list_ = std::make_shared<List>(*list_);
    return *list_;
  }

  std::shared_ptr<List> list_;  // null: empty
};

}  // namespace heliograph::scene
