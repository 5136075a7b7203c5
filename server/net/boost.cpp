// The compiled part of Boost.Asio and Boost.Beast, kept out of every other source.
#include <boost/asio/impl/src.hpp>
#include <boost/asio/ssl/impl/src.hpp>
#include <boost/beast/src.hpp>
