// A house in a meadow, drawn in three depths, in a field of 240 by 140.

export const BALLOON = "#db4bb0"; // the colour that stands for all the others

const sky = (id) => `
  <defs><linearGradient id="${id}-sky" x1="0" y1="0" x2="0" y2="1"><stop offset="0" stop-color="#4f90db"/>
  <stop offset="1" stop-color="#b7d9f7"/></linearGradient></defs><rect width="240" height="140" fill="url(#${id}-sky)"/>`;
const hills = `
  <path d="M0 92C40 74 84 74 122 86S204 74 240 88V140H0z" fill="#518c6f"/>
  <path d="M0 100C50 84 96 88 140 96S210 92 240 96V140H0z" fill="#579e76"/>`;
const far = (id) => `${sky(id)}<circle cx="34" cy="26" r="13" fill="#fcdb32"/><g fill="#f2f7fc">
  <ellipse cx="178" cy="28" rx="16" ry="11"/><ellipse cx="196" cy="24" rx="17" ry="13"/>
  <ellipse cx="212" cy="30" rx="13" ry="9"/><ellipse cx="195" cy="34" rx="27" ry="7"/></g>${hills}
  <path d="M88 13c-13 0-20 9-20 19 0 11 10 19 15 24h10c5-5 15-13 15-24 0-10-7-19-20-19z" fill="#db4bb0"/>
  <path d="M88 13c-5 3-8 11-8 19 0 10 4 19 6 24h4c2-5 6-14 6-24 0-8-3-16-8-19z" fill="#f5cf36"/>
  <path d="M88 13c-1.6 4-2.6 11-2.6 19s1 18 1.6 24h2c.6-6 1.6-16 1.6-24s-1-15-2.6-19z" fill="#db4bb0"/>
  <path d="M84 57l1 5M92 57l-1 5" stroke="#593924" stroke-width=".8"/>
  <rect x="84" y="62" width="8" height="6" rx="1.4" fill="#73492e"/>`;
const middle = `
  <path d="M0 112C60 100 110 98 160 101S220 102 240 98V140H0z" fill="#4f9934"/>
  <path d="M158 70h34v36h-34z" fill="#f7eddf"/><path d="M192 70l20 2v31l-20 3z" fill="#d6c8b4"/>
  <path d="M152 71l16-20h36l-12 20z" fill="#cc3525"/><path d="M204 51l14 22-26-2z" fill="#9e291c"/>
  <path d="M188 46h7v10h-7z" fill="#803b33"/><rect x="170" y="85" width="9" height="21" fill="#8c5423"/>
  <rect x="161.500" y="78" width="6" height="7" fill="#70bdcc"/><rect x="182" y="78" width="6" height="7" fill="#70bdcc"/>
  <rect x="198" y="79" width="5" height="7" fill="#62a5b2"/>
  <path d="M0 84C44 94 92 112 138 140H76C52 122 26 106 0 98z" fill="#858585"/>
  <path d="M0 84C44 94 92 112 138 140h-3C90 113 44 95 0 86zM0 98C26 106 52 122 76 140h3C54 121 26 105 0 96z" fill="#666666"/>
  <path d="M0 91C36 100 74 118 106 140" fill="none" stroke="#e6e6e6" stroke-width="1.8" stroke-dasharray="7 6"/>`;
const near = `
  <path d="M0 126C20 122 44 128 62 140H0z" fill="#42802b"/><path d="M150 140c24-14 60-20 90-18v18z" fill="#42802b"/>
  <circle cx="8" cy="132" r="2.6" fill="#f26b1d"/><circle cx="8" cy="132" r="1.04" fill="#f5cf36"/>
  <circle cx="20" cy="135" r="2.2" fill="#f26b1d"/><circle cx="20" cy="135" r="0.88" fill="#f5cf36"/>
  <circle cx="30" cy="131" r="2" fill="#f26b1d"/><circle cx="30" cy="131" r="0.8" fill="#f5cf36"/>
  <circle cx="42" cy="136" r="2.4" fill="#f26b1d"/><circle cx="42" cy="136" r="0.96" fill="#f5cf36"/>
  <circle cx="172" cy="134" r="2.6" fill="#f26b1d"/><circle cx="172" cy="134" r="1.04" fill="#f5cf36"/>
  <circle cx="184" cy="128" r="2.1" fill="#f26b1d"/><circle cx="184" cy="128" r="0.84" fill="#f5cf36"/>
  <circle cx="196" cy="133" r="2.8" fill="#f26b1d"/><circle cx="196" cy="133" r="1.12" fill="#f5cf36"/>
  <circle cx="208" cy="127" r="2.2" fill="#f26b1d"/><circle cx="208" cy="127" r="0.88" fill="#f5cf36"/>
  <circle cx="218" cy="133" r="2.5" fill="#f26b1d"/><circle cx="218" cy="133" r="1" fill="#f5cf36"/>
  <circle cx="230" cy="127" r="2.7" fill="#f26b1d"/><circle cx="230" cy="127" r="1.08" fill="#f5cf36"/>`;

// The scene without blur.
export const scene = (id) => `<g data-part="scene">${far(id)}${middle}${near}</g>`;

const blur = (id, name) => `<filter id="${id}-${name}" x="-10%" y="-30%" width="120%" height="160%">
  <feGaussianBlur data-part="${name}" stdDeviation="0"/></filter>`;

// The scene with blurs by depth; sky and hills lie once more behind the blurred ones, whose edges are transparent.
export const sceneByDepth = (id) => `<defs>${["far", "middle", "near"].map((name) => blur(id, name)).join("")}
  <clipPath id="${id}-frame"><rect width="240" height="140"/></clipPath></defs>
  <g data-part="scene" clip-path="url(#${id}-frame)">${sky(`${id}-behind`)}${hills}<g filter="url(#${id}-far)">${far(id)}</g>
  <g filter="url(#${id}-middle)">${middle}</g><g filter="url(#${id}-near)">${near}</g></g>`;
