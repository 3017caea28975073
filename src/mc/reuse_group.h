// Reuse in a group of domains, each of which uses the samples of all others: every sample is evaluated in every domain,
// so that n domains need n (n - 1) evaluations for balance weights over all of them; n separate neighbourhoods would
// need n times as many.
#pragma once
#include <memory>

#include "mc/reuse.h"

namespace montelux {

// What a group requires of its domains:
//   Image own(int of, const T& value, Mask<F> on)
//       a sample of domain `of` in that domain;
//   and one of these two:
//   Image image(int from, int to, const T& value, Mask<F> on)
//       the image of a sample of domain `from` in another domain `to`;
//   void images(int from, const T& value, std::span<const Mask<F>> on, std::span<Image> all)
//       the images in all domains at once, its own included, if that is faster than one by one.
// Image has `jacobian` and `target`, as Shifted has, and whatever else differs from domain to domain; it has
// `select(Mask<F>, Image, Image)`. The maps must compose: the map from i to k equals that by way of j wherever there is
// an image in j.
template <class D, class T, class F>
concept ReuseGroupDomains = requires(const D& domains, const T& value, Mask<F> on) {
  { domains.own(0, value, on).jacobian } -> std::convertible_to<F>;
  { domains.own(0, value, on).target } -> std::convertible_to<F>;
};

// An image among those of which a domain chooses one.
template <class Image, class F>
struct GroupCandidate {
  Image image;   // in the domain that chooses
  Uint<F> from;  // of the sample of that domain
};
template <class Image, class F>
MONTELUX_INLINE GroupCandidate<Image, F> select(Mask<F> m, const GroupCandidate<Image, F>& a,
                                                const GroupCandidate<Image, F>& b) requires(lanes_of<F> > 1) {
  return {select(m, a.image, b.image), select(m, a.from, b.from)};
}

// What a domain has chosen from the samples of its group. There is an image where the weight is not 0.
template <class Image, class F>
struct GroupChoice : GroupCandidate<Image, F> {
  F weight;      // as in Reservoir; 0: nothing was found
  F confidence;  // of the whole group; 0 for a domain that is ignored
};

// The images of a sample in all domains, where on[k].
template <class T, class F, class Domains, class Image>
void find_images(const Domains& domains, std::size_t from, const T& value, std::span<const Mask<F>> on,
                 std::span<Image> images) {
  if constexpr (requires { domains.images(int(from), value, on, images); })
    domains.images(int(from), value, on, images);
  else
    for (std::size_t k = 0; k < images.size(); ++k)
      images[k] = k == from ? domains.own(int(from), value, on[k]) : domains.image(int(from), int(k), value, on[k]);
}

// Chooses for each domain one of the samples of all of them. Domains of confidence 0 are ignored. `stream` gives
// numbers from its start.
//
// As the maps compose, the share of a sample by the balance heuristic over all domains is the same in every domain
// that uses it: c_i p_i / sum over k of c_k p_k(image in k) |Jacobian|. each(k, image, w, on) receives, for every
// domain and every sample, the weight of h(image) in the estimate of the integral of h over domain k (the
// mean over the choice, Rao and Blackwell).
template <class T, class F, class Domains, class Each>
auto combine_group(std::span<const Reservoir<T, F>> group, const Domains& domains, const RandomStream<F>& stream,
                   Mask<F> on, Each&& each) requires ReuseGroupDomains<Domains, T, F> {
  using ImageOf = decltype(domains.own(0, group[0].value, on));
  const std::size_t n = group.size();
  std::vector<WeightedReservoir<GroupCandidate<ImageOf, F>, F>> chosen(n);
  std::vector<ImageOf> images(n);
  const auto queried = std::make_unique<Mask<F>[]>(n);
  std::vector<F> confidences(n);
  F all = 0.0f;
  for (std::size_t k = 0; k < n; ++k)
    confidences[k] = usable_confidence(group[k].confidence), all = all + confidences[k];
  for (std::size_t i = 0; i < n; ++i) {
    const Reservoir<T, F>& sample = group[i];
    const Mask<F> live = on & (sample.weight > F(0.0f)) & (confidences[i] > F(0.0f));
    if (!any(live)) continue;
    const F own = confidences[i] * sample.target;
    F sum = own;
    for (std::size_t k = 0; k < n; ++k) queried[k] = live & (confidences[k] > F(0.0f));
    find_images<T, F>(domains, i, sample.value, std::span<const Mask<F>>(queried.get(), n), std::span<ImageOf>(images));
    for (std::size_t k = 0; k < n; ++k) {
      if (k == i) images[k].target = sample.target, images[k].jacobian = F(1.0f);
      images[k].target = select(queried[k] & (images[k].jacobian > F(0.0f)), images[k].target, F(0.0f));
      if (k != i)
        sum = sum + select(images[k].target > F(0.0f), confidences[k] * images[k].target * images[k].jacobian, F(0.0f));
    }
    const F share = select(live, usable_weight<F>(own / sum * sample.weight), F(0.0f));
    for (std::size_t k = 0; k < n; ++k) {
      const F per_target = share * images[k].jacobian;
      const F w = select(images[k].target > F(0.0f), usable_weight<F>(per_target * images[k].target), F(0.0f));
      chosen[k].add({images[k], Uint<F>(std::uint32_t(i))}, w, stream.at(Uint<F>(std::uint32_t(i * n + k))));
      each(k, images[k], per_target, Mask<F>(w > F(0.0f)));
    }
  }
  std::vector<GroupChoice<ImageOf, F>> choices(n);
  for (std::size_t k = 0; k < n; ++k) {
    const F& target = chosen[k].value.image.target;
    const Mask<F> found = on & (chosen[k].weight_sum > F(0.0f)) & (target > F(0.0f));
    const F weight = select(found, usable_weight<F>(chosen[k].weight_sum / target), F(0.0f));
    choices[k] = {chosen[k].value, weight, select(confidences[k] > F(0.0f), all, F(0.0f))};
  }
  return choices;
}

}  // namespace montelux
