//! Makes the build one file: script and style go into the page, with a policy that allows these two and nothing else.

import { createHash } from "node:crypto";
import type { Plugin } from "vite";

/** What a browser may do for the page: run this script, use this style, ask the server that it came from. */
function policy(script: string, style: string): string {
  const hash = (text: string) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
  return [
    "default-src 'none'",
    `script-src ${hash(script)}`,
    `style-src ${hash(style)}`,
    "connect-src 'self'",
    "img-src data:",
    "base-uri 'none'",
    "form-action 'none'",
  ].join("; ");
}

export function oneFile(): Plugin {
  return {
    name: "one-file",
    enforce: "post",
    generateBundle(_options, bundle) {
      let script = "";
      let style = "";
      for (const [name, part] of Object.entries(bundle)) {
        if (part.type === "chunk") script += part.code;
        else if (name.endsWith(".css")) style += part.source.toString();
        else continue;
        delete bundle[name];
      }
      const page = bundle["index.html"];
      if (page?.type !== "asset" || script === "" || style === "") {
        throw new Error("expected a page, a script and a style to make one file of");
      }
      // Nothing in a script may end the element that it stands in.
      script = `\n${script.replaceAll("</script", "<\\/script").trim()}\n`;
      style = `\n${style.trim()}\n`;
      const bare = page.source
        .toString()
        .replace(/\s*<script type="module"[^>]*><\/script>/, "")
        .replace(/\s*<link rel="stylesheet"[^>]*>/, "");
      const head = `<meta http-equiv="Content-Security-Policy" content="${policy(script, style)}" />`;
      page.source = bare
        .replace('<meta charset="utf-8" />', () => `<meta charset="utf-8" />\n    ${head}`)
        .replace("</head>", () => `  <style>${style}</style>\n  </head>`)
        .replace("</body>", () => `  <script type="module">${script}</script>\n  </body>`);
    },
  };
}
