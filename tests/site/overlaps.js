// Texts and pictures of a page that lie upon one another, as pairs of what they say.
() => {
  // Lines of neighbouring blocks may touch, and letters reach out of their lines.
  const SHARED = 3;
  const boxes = [];
  const add = (element, rects, said) => {
    for (const r of rects) {
      if (r.width > SHARED && r.height > SHARED) boxes.push({ element, said, ...r.toJSON() });
    }
  };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    // Formulas are set by the browser, with signs upon signs.
    if (!node.data.trim() || node.parentElement.closest("math, script, option, .skip")) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    add(node.parentElement, range.getClientRects(), node.data.trim().slice(0, 40));
  }
  for (const element of document.querySelectorAll("img, canvas, button, input, select")) {
    add(element, [element.getBoundingClientRect()], element.outerHTML.slice(0, 40));
  }
  boxes.sort((a, b) => a.top - b.top);
  const found = [];
  boxes.forEach((one, place) => {
    for (let next = place + 1; next < boxes.length && boxes[next].top < one.bottom - SHARED; next++) {
      const other = boxes[next];
      const wide = Math.min(one.right, other.right) - Math.max(one.left, other.left);
      const high = Math.min(one.bottom, other.bottom) - other.top;
      const within = one.element.contains(other.element) || other.element.contains(one.element);
      if (wide > SHARED && high > SHARED && !within) found.push([one.said, other.said]);
    }
  });
  return found;
}
