// The report's style sheet. Plain: readable on paper, on a phone and in the dark.
#pragma once

namespace sunfleck::report {

inline constexpr char kStyle[] = R"(
:root { --ink: #1c2a24; --quiet: #5d6b64; --line: #d8dfda; --paper: #fbfcfa; --leaf: #2f7d4f; --tint: #eef4ef; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.55 "Source Sans 3", "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif; }
main { max-width: 1120px; margin: 0 auto; padding: 1.5rem 1.25rem 4rem; }
header h1 { font-size: 2rem; line-height: 1.2; margin: 0.5rem 0 0.25rem; }
header p { margin: 0; color: var(--quiet); }
nav { margin: 1rem 0 0; font-size: 0.92rem; }
nav a { color: var(--leaf); margin-right: 1rem; text-decoration: none; }
nav a:hover { text-decoration: underline; }
h2 { font-size: 1.35rem; margin: 2.6rem 0 0.8rem; padding-top: 0.7rem; border-top: 2px solid var(--leaf); }
h3 { font-size: 1.08rem; margin: 1.6rem 0 0.5rem; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 0.75rem; margin: 1.4rem 0; }
.card { background: var(--tint); border-radius: 8px; padding: 0.8rem 0.9rem; }
.card b { display: block; font-size: 1.45rem; line-height: 1.25; font-weight: 600; white-space: nowrap; }
.card b small { font-size: 0.85rem; font-weight: 400; }
.card span { color: var(--quiet); font-size: 0.88rem; }
.facts { display: grid; grid-template-columns: max-content 1fr; gap: 0.25rem 1.4rem; margin: 0.5rem 0; }
.facts dt { color: var(--quiet); }
.facts dd { margin: 0; overflow-wrap: anywhere; }
figure { margin: 1rem 0; }
figure img { max-width: 100%; height: auto; display: block; background: #fff; border-radius: 6px; }
img.wide { width: 100%; }
img.map { width: min(100%, 820px); }
img.half { width: min(100%, 560px); }
figcaption, .quiet { color: var(--quiet); font-size: 0.9rem; }
.scroll { overflow: auto; max-height: 34rem; margin: 1rem 0; border: 1px solid var(--line); border-radius: 6px; }
table { border-collapse: collapse; width: 100%; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding: 0.6rem 0.7rem; color: var(--quiet); font-size: 0.9rem; }
th { position: sticky; top: 0; background: var(--tint); text-align: right; font-weight: 600; vertical-align: bottom; }
th, td { padding: 0.32rem 0.7rem; border-bottom: 1px solid var(--line); }
td { text-align: right; white-space: nowrap; }
th.l, td.l { text-align: left; }
tbody tr:hover { background: var(--tint); }
.photos { display: grid; grid-template-columns: repeat(auto-fill, minmax(150px, 1fr)); gap: 0.9rem; }
.photo { margin: 0; text-align: center; }
.compass { position: relative; }
.compass img { width: 100%; border-radius: 50%; image-rendering: auto; }
.compass i { position: absolute; font: 600 0.72rem/1 sans-serif; color: #c3342f; background: #ffffffd9; border-radius: 3px;
  padding: 1px 3px; }
.compass .n { top: 0; left: 50%; transform: translateX(-50%); }
.compass .s { bottom: 0; left: 50%; transform: translateX(-50%); }
.compass .e { left: 0; top: 50%; transform: translateY(-50%); }
.compass .w { right: 0; top: 50%; transform: translateY(-50%); }
summary { cursor: pointer; color: var(--leaf); margin: 0.6rem 0; }
@media print { .scroll { max-height: none; overflow: visible; } details { display: block; } nav { display: none; } }
)";

}  // namespace sunfleck::report
