// SPDX-License-Identifier: Apache-2.0
import { defineConfig, type Plugin, type UserConfig } from 'vite';

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

const kCommon = { target: 'es2022', cssCodeSplit: false, modulePreload: false, emptyOutDir: false } as const;

/** dist/service.html with /app.js and /app.css: the service allows no script and no style within a page. */
const kService: UserConfig = {
  base: '/',
  build: {
    ...kCommon,
    assetsInlineLimit: 0,
    rollupOptions: {
      input: 'service.html',
      output: { inlineDynamicImports: true, entryFileNames: 'app.js', assetFileNames: 'app[extname]' },
    },
  },
};

/**
 * `vite build` makes report.html of index.html, `vite build --mode summary` summary.html, each one file;
 * `vite build --mode service` the page of the service, three files.
 */
export default defineConfig(({ mode }) => {
  if (mode === 'service') return kService;
  const summary = mode === 'summary';
  const source = summary ? 'summary.html' : 'index.html';
  return {
    base: './',
    plugins: [inlineEverything(source, summary ? 'summary.html' : 'report.html')],
    build: {
      ...kCommon,
      assetsInlineLimit: 1e8,
      rollupOptions: { input: source, output: { inlineDynamicImports: true } },
    },
  };
});
