// SPDX-License-Identifier: Apache-2.0
import { defineConfig, type Plugin } from 'vite';

/** Text that may stand in an inline script: nothing in it ends the element. */
const scriptSafe = (code: string): string => code.replace(/<\/(script)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');

/** Puts the one script and the one style sheet into the page `source`, so that it is one file, dist/`file`. */
function inlineEverything(source: string, file: string): Plugin {
  return {
    name: 'inline-everything',
    enforce: 'post',
    generateBundle(_options, bundle) {
      const page = bundle[source];
      if (page?.type !== 'asset') throw new Error(`the build has no ${source}`);
      let html = String(page.source).replace(/\s*<(script|link)[^>]*(src|href)="[^"]*"[^>]*>(<\/script>)?/g, '');
      for (const [name, part] of Object.entries(bundle)) {
        if (part === page) continue;
        const style = part.type === 'asset' && name.endsWith('.css');
        if (style) html = html.replace('</head>', () => `<style>${String(part.source)}</style></head>`);
        if (part.type === 'chunk') {
          html = html.replace('</body>', () => `<script type="module">${scriptSafe(part.code)}</script>\n</body>`);
        }
        if (style || part.type === 'chunk') delete bundle[name];
      }
      page.source = html;
      page.fileName = file;
    },
  };
}

/** A page of its own file each: `vite build` makes report.html of index.html, `vite build --mode summary` the other. */
export default defineConfig(({ mode }) => {
  const summary = mode === 'summary';
  const source = summary ? 'summary.html' : 'index.html';
  return {
    base: './',
    plugins: [inlineEverything(source, summary ? 'summary.html' : 'report.html')],
    build: {
      target: 'es2022',
      assetsInlineLimit: 1e8,
      cssCodeSplit: false,
      modulePreload: false,
      emptyOutDir: false,
      rollupOptions: { input: source, output: { inlineDynamicImports: true } },
    },
  };
});
