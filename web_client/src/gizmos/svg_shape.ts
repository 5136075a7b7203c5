const svgNamespace = "http://www.w3.org/2000/svg";

export function svgShape(name: string, attributes: Record<string, number | string>): SVGElement {
  const node = document.createElementNS(svgNamespace, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, String(value));
  return node;
}
