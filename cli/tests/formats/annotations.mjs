// Makes annotations.json: findings, and the lines that GitHub's own package writes for them. The test in cli/src/findings/github.rs holds
// our lines against these.
//
//     npm install --prefix /tmp/judges @actions/core@3.0.1
//     node cli/tests/formats/annotations.mjs /tmp/judges/node_modules/@actions/core

import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const folder = process.argv[2];
const { version } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
const core = await import(pathToFileURL(`${folder}/lib/core.js`));

const file = "pipelines/first.ron";
const findings = [
    { title: "lavapipe", file, message: "plain" },
    { title: "a, b: c; d=e", file: "a,b:c;d=e.ron", message: "a, b: c; d=e" },
    { title: "100%", file: "100%25%2C%3A.ron", message: "100% of %0A and %25" },
    { title: "lavapipe", file, message: "one\ntwo\r\nthree\rfour" },
    { title: "::error::", file: "::error file=x::.ron", message: "::error file=x::y\n::stop-commands::z" },
    { title: "\"<b>'&]]>", file: "\"<b>'&]]>.ron", message: "</script><img src=x onerror=y>" },
    { title: "Größe 漢字 😀", file: "Größe 漢字 😀.ron", message: "שלום" },
    { title: " ", file: " .ron", message: " " },
];

let line;
process.stdout.write = (text) => { line = text; return true; };
const written = findings.map((finding, at) => {
    const [startLine, startColumn] = [at + 1, at + 2];
    const place = { startLine, startColumn, endLine: startLine + 1, endColumn: startColumn + 3 };
    core.error(finding.message, { title: `framewright, ${finding.title}`, file: finding.file, ...place });
    return { ...finding, ...place, line };
});
const made = { judge: `@actions/core ${version}`, findings: written };
writeFileSync(new URL("annotations.json", import.meta.url), JSON.stringify(made, null, 2) + "\n");
